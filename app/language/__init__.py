"""The language of what users read: English is in the code, others are in catalogues of gettext beside this file.

`translate` is where a text is written or shown, `mark` where it is written and shown later. `use_language` chooses.
"""
