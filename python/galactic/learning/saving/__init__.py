"""Saving and loading runs and policies. Start reading at `checkpoint.py`."""
