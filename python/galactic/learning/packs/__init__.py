"""Policy packs: a trained policy as layers that galactic-run plays. Start reading at `content.py`."""
