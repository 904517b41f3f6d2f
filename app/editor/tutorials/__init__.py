"""Tutorials inside the editor: lessons on the sample render, each a few steps with the next one highlighted.

A lesson is data (`lessons.py`): sentences, the widget that each is about, and a question to the document that says when
the step is done. `coach.py` draws the current step beside its widget and goes on when the question is answered.
"""
