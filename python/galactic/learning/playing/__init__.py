"""Episodes are played, each once: to judge policies, and to show what an expert does. Start reading at `evaluation.py`."""
