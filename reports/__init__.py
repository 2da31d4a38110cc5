"""The page of results: figures and tables made from run folders alone."""
