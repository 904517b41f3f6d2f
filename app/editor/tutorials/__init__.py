"""Tutorials inside the editor: lessons on the sample render, each a few steps with the next one highlighted.

A lesson is data: sentences, the widget that each is about, and a question to the document that says when the step is
done. `lessons.py` has those about the editor, `course.py` those about the techniques. `coach.py` draws the current
step beside its widget and goes on when the question is answered.
"""
