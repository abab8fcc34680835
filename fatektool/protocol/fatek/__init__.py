"""The manufacturer's own protocols: FACON and M-series, and what they share."""
