/* Theme and table of contents of a page. In place of the theme's own script, an ES module of which Debian ships the
source and which no browser loads from a file. */
(() => {
  const body = document.body, root = document.documentElement;
  root.classList.remove("no-js");
  const stored = (name, value) => {
    try {
      if (value === undefined) return localStorage.getItem(name);
      localStorage.setItem(name, value);
    } catch (blocked) { /* private windows keep the theme of the page alone */ }
    return null;
  };

  const themes = () => matchMedia("(prefers-color-scheme: dark)").matches ? ["auto", "light", "dark"]
    : ["auto", "dark", "light"];
  const show = theme => {
    body.dataset.theme = theme;
    for (const button of document.getElementsByClassName("theme-toggle"))
      button.title = `Colours: ${theme === "auto" ? "as the system" : theme}`;
  };
  const next = () => {
    const order = themes(), theme = order[(order.indexOf(body.dataset.theme) + 1) % 3];
    show(theme);
    stored("theme", theme);
  };
  const begun = stored("theme");
  show(themes().includes(begun) ? begun : "auto");
  for (const button of document.getElementsByClassName("theme-toggle")) button.addEventListener("click", next);

  /* The heading that is read, in the contents of the page. */
  const links = [...document.querySelectorAll(".toc-tree a[href^='#']")];
  const heads = links.map(link => document.getElementById(decodeURIComponent(link.hash.slice(1)))).map(
    section => section && (section.querySelector("h1, h2, h3, h4") ?? section));
  const mark = () => {
    let current = 0;
    heads.forEach((head, n) => { if (head && head.getBoundingClientRect().top < 90) current = n; });
    links.forEach((link, n) => link.parentElement.classList.toggle("scroll-current", n === current));
    root.classList.toggle("show-back-to-top", scrollY > innerHeight);
    document.querySelector("header.mobile-header")?.classList.toggle("scrolled", scrollY > 0);
  };
  let asked = false;
  addEventListener("scroll", () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => { asked = false; mark(); });
  }, { passive: true });
  mark();

  /* Keys in tables may break behind dots and underscores. */
  const walk = (node, change) => {
    for (const child of [...node.childNodes]) child.nodeType === Node.TEXT_NODE ? change(child) : walk(child, change);
  };
  for (const code of document.querySelectorAll("article td code"))
    if (code.textContent.length > 12)
      walk(code, text => {
        const parts = text.data.split(/(?<=[._/])/);
        text.replaceWith(...parts.flatMap((part, n) => n ? [document.createElement("wbr"), part] : [part]));
      });
  /* Tables of sentences become lists on a phone (site.css), with the name of its column before each cell. */
  for (const table of document.querySelectorAll("article table.docutils")) {
    const names = [...table.querySelectorAll("thead th")].map(head => head.textContent.trim());
    const cells = [...table.querySelectorAll("tbody td")];
    if (!names.some(name => name) || !cells.some(cell => cell.textContent.length > 45)) continue;
    table.classList.add("stacked");
    for (const cell of cells) {
      const name = names[cell.cellIndex];
      if (!cell.textContent.trim()) cell.replaceChildren();
      else if (cell.cellIndex && name && names.length > 2) cell.dataset.label = name;
    }
  }

  /* The sidebar shows where this page stands. */
  const here = document.querySelector(".sidebar-tree .current-page");
  const scroll = document.querySelector(".sidebar-scroll");
  if (here && scroll && here.offsetTop > scroll.clientHeight * 0.8)
    scroll.scrollTop = here.offsetTop - scroll.clientHeight / 2;
})();
