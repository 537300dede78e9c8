"""Collects rollouts: policies act, and environments step. Start reading at `collector.py`."""
