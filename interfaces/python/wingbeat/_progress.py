"""Progress of long calls."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def shown(
    progress: bool | Callable[[int, int], object] | None, total: int
) -> Iterator[Callable[[int, int], object] | None]:
    """What a long call reports to: nothing, the user's function, or a bar."""
    if not progress:
        yield None
        return
    if callable(progress):
        yield progress
        return
    try:
        from tqdm.auto import tqdm
    except ImportError:
        yield lambda done, designs: print(f"\r{done} of {designs} designs", end="", file=sys.stderr)
        print(file=sys.stderr)
        return
    with tqdm(total=total, unit=" designs") as bar:
        yield lambda done, _: bar.update(done - bar.n)
        bar.update(total - bar.n)
