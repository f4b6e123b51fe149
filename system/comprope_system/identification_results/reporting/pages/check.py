"""The page of `comprope check`."""

from pathlib import Path

import pandas as pd

from ....report.page import Block, Section, Table, save_page


def save_check(path: Path, headline: str, found: pd.DataFrame) -> None:
    """Write the page of a check from its rows of file, kind and sentence, completely or not at all."""
    table = Table(list(found.columns), [[str(cell) for cell in row] for row in found.itertuples(index=False)])
    blocks: list[Block] = [table if len(found) else "None: every file is read as campaign.toml describes it."]
    save_page(path, "Check of a campaign", headline, [Section("check", "Problems and remarks", blocks)])
