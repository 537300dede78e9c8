"""The user's classes and functions, by the names that the command line gives. Start reading at
`own_code.py`."""
