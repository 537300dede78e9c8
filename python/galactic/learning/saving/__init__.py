"""What is saved of runs and policies, and how it is read again. Start reading at `checkpoint.py`."""
