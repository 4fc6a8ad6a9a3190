"""The explorer in the pages of the manual, where a page explains a mechanism."""
import re

mark = re.compile(r"^<!-- explorer: ([\w, -]+?) of ([\w-]+) -->$", re.M)


def framed(text, explorer, place, designs):
    """`<!-- explorer: PICTURES of VEHICLE -->` becomes these pictures of the explorer in a frame, which loads when the
    reader opens it; nothing where the explorer was not built. `place` is that of the page in the site."""
    def frame(match):
        pictures, vehicle = match[1].replace(" ", ""), match[2]
        if not (designs / f"{vehicle}.toml").is_file():
            raise LookupError(f"{place} shows {vehicle} in the explorer, which is no vehicle of {designs.name}")
        if not explorer.exists():
            return ""
        page, state = "../" * place.count("/") + explorer.name, f"#vehicle={vehicle}"
        return ("```{raw} html\n"
                f'<details class="explorer"><summary>See it move, in the explorer</summary><iframe loading="lazy" '
                f'title="{vehicle} in the explorer" src="{page}?embed={pictures}{state}"></iframe><p><a '
                f'href="{page}{state}">Change it in the explorer</a></p></details>\n```')

    return mark.sub(frame, text)
