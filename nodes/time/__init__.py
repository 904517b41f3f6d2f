"""Other frames: offset, speed and freeze, blending, feedback and memory."""
