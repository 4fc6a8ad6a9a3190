/* Measures the contrast of every text of the pages in the frames, in the themes that the system and the button give;
what is below `required`, or not of that theme, stands in #found as JSON. docs/site/checks.py makes the page with the
frames, which has loaded when they have. */
window.addEventListener("load", () => {
  const found = new Map();
  let texts = 0;
  const channels = text => {
    const numbers = (text.match(/[\d.]+/g) ?? [0, 0, 0, 0]).map(Number);
    return [numbers[0], numbers[1], numbers[2], numbers[3] ?? 1];
  };
  const over = ([r, g, b, a], ground) => [r, g, b].map((value, n) => a * value + (1 - a) * ground[n]);
  const luminance = colour => {
    const [r, g, b] = colour.map(value => {
      const c = value / 255;
      return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
    });
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const groundOf = (window, node) => {
    const layers = [];
    for (let up = node; up; up = up.parentElement) layers.push(channels(window.getComputedStyle(up).backgroundColor));
    let ground = [255, 255, 255];
    for (const layer of layers.reverse()) ground = over(layer, ground);
    return ground;
  };
  const measure = (window, name, theme) => {
    const walk = window.document.createTreeWalker(window.document.body, NodeFilter.SHOW_TEXT);
    for (let text = walk.nextNode(); text; text = walk.nextNode()) {
      const node = text.parentElement;
      if (!text.data.trim() || !node.checkVisibility?.()) continue;
      if (node.closest(".visually-hidden, script, style, noscript")) continue;
      const style = window.getComputedStyle(node), ground = groundOf(window, node);
      if (Number(style.opacity) === 0 || style.visibility === "hidden") continue;
      const painted = node.namespaceURI === "http://www.w3.org/2000/svg" ? style.fill : style.color;
      const [lighter, darker] = [luminance(over(channels(painted), ground)), luminance(ground)].sort((a, b) => b - a);
      const contrast = (lighter + 0.05) / (darker + 0.05);
      ++texts;
      if (contrast >= required) continue;
      const what = `${name}, ${theme}: ${node.tagName.toLowerCase()}.${node.getAttribute("class") ?? ""}`;
      if (!found.has(what)) found.set(what, `${what} "${text.data.trim().slice(0, 30)}": ${contrast.toFixed(2)}`);
    }
  };
  const system = location.hash.slice(1);
  for (const frame of document.querySelectorAll("iframe")) {
    const name = frame.getAttribute("src"), window = frame.contentWindow, body = window.document.body;
    const turn = theme => {
      const dark = luminance(groundOf(window, body)) < 0.2;
      if (dark !== (theme === "dark")) found.set(name + theme, `${name} is not ${theme} on a ${system} system`);
      measure(window, name, `${theme} on a ${system} system`);
    };
    turn(system);
    /* Of the button's three themes the second is the other one. */
    window.document.querySelector(".theme-toggle-content .theme-toggle").click();
    turn(system === "dark" ? "light" : "dark");
  }
  document.getElementById("found").textContent = JSON.stringify({ texts, found: [...found.values()] });
});
