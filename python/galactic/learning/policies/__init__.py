"""From observations to actions: networks, and which parts of an observation they see. Start reading at `networks.py`."""
