"""Recurrent, distributed PPO for galactic's worlds: what `python3 -m galactic.train` runs.

The only part of the package that needs torch. Start reading at `trainer.py`.
"""
