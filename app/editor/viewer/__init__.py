"""The viewer: pictures, how they are shown, and what they measure."""
