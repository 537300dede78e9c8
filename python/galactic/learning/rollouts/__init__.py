"""Policies act, environments step, a rollout fills. Start reading at `collector.py`."""
