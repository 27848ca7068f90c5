"""`workbench doctor`: versions, graphics, plugins, and the command that installs what is missing."""

from __future__ import annotations

import argparse


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="versions, graphics, plugins; what is missing and how to install it")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Print every finding; the findings are the result, so the status is 0 whatever they are."""
    from workbench.engine.doctor import examine

    healthy = True
    for section in examine():
        print(section.title)
        width = min(max(len(finding.name) for finding in section.findings), 24)
        for finding in section.findings:
            healthy &= finding.good
            print(f"  {'' if finding.good else '! '}{finding.name:{width}}  {finding.value}".rstrip())
            for line in (finding.remedy, *finding.details.splitlines()):
                if line:
                    print(f"      {line}")
    print("All is well." if healthy else "Lines with ! need attention.")
    return 0
