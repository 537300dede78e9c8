"""What improves a policy, by rollouts. Start reading at `learner.py`."""
