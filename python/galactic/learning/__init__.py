"""Recurrent, distributed PPO for galactic's worlds: what `python3 -m galactic.train` runs.

The only part of the package that needs torch. Start reading at `trainer.py`. For your own training
loops, `encoders` and `sequences` have the parts of networks, read_policy() reads what the trainer
has saved, and export_module() makes policy packs.
"""

from galactic.learning.packs.own_modules import ActionParameters, export_module
from galactic.learning.saving.checkpoint import SavedPolicy, read_policy

__all__ = ["ActionParameters", "SavedPolicy", "export_module", "read_policy"]
