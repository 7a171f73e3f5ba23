"""Exceptions of Catena, with the messages of the program."""


class Error(Exception):
    """Base of all errors of Catena. The message is one line: what is wrong, where, and what to do."""


class InputError(Error, ValueError):
    """The input is wrong: a scene, a value or an argument. The program would exit with status 2."""


class ComputationError(Error, RuntimeError):
    """The computation failed with valid input. The program would exit with status 1."""


class Note(UserWarning):
    """Warning about what Catena assumed, changed or left out when it read a scene."""
