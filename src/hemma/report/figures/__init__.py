"""Every figure of the report, one module each."""
