"""The six panels of the results, apart and together."""
