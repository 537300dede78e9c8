"""Improves a policy with rollouts. Start reading at `learner.py`."""
