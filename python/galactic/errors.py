"""The exception that the library raises."""

from galactic._core import ErrorCode


class Error(Exception):
    """What went wrong and where, in words that you can act on.

    Attributes:
        code: the reason, as an ErrorCode.
        where: the file, with element and field, or the option.
        message: one sentence: what was found, what was expected, what to do.
    """

    def __init__(self, code: int, where: str, message: str) -> None:
        super().__init__(code, where, message)
        self.code = ErrorCode(code)
        self.where = where
        self.message = message

    def __str__(self) -> str:
        return f"{self.where}: {self.message}"
