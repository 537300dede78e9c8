"""Several processes that train together. Start reading at `distributed.py`."""
