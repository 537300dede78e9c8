"""Processes that train one policy together. Start reading at `distributed.py`."""
