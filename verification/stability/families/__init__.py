"""The families of the atlas: every module here lists some as FAMILIES."""
