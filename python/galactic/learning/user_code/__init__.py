"""Classes and functions of the user's, by what the command line calls them. Start reading at `own_code.py`."""
