"""Plays episodes, each exactly once: to judge policies, and to record demonstrations. Start reading
at `evaluation.py`."""
