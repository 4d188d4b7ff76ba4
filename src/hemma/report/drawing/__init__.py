"""What all figures share: canvas, rows of methods, names beside points."""
