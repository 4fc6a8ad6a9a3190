"""Tables, quantities and the top of a page, as all study pages have them."""

# Units that the vehicle file uses, with the factor from SI.
shown = {"m": (1e3, "mm"), "N": (1e3, "mN"), "N m/rad": (1e3, "mN m/rad")}


def quantity(x, unit):
    factor, name = shown.get(unit, (1.0, unit))
    return f"{factor * x:.4g}" + ("" if name == "1" else f" {name}")


def span(low, high):
    return f"{low:.4g} to {high:.4g}"


def table(head, rows):
    return [f"| {' | '.join(head)} |", "| " + " | ".join("---" for _ in head) + " |",
            *(f"| {' | '.join(row)} |" for row in rows)]


def sources(*names):
    files = [f"[data/studies/{name}.toml](../../data/studies/{name}.toml)" for name in names]
    return f"`scripts/run-studies` makes this page from {' and '.join(files)}."


def joined(parts):
    return parts[0] if len(parts) == 1 else ", ".join(parts[:-1]) + " and " + parts[-1]
