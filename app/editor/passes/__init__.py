"""The Passes panel: how the picture of the viewer is made, pass by pass."""
