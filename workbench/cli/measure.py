"""Stub."""
import argparse
def add_parser(name, commands):
    commands.add_parser(name)
