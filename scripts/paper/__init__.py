"""The reproduction of the paper: one module a figure, run by ``python -m scripts.paper``."""
