"""The tables as rows of text."""
