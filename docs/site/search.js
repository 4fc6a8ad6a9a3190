/* The search of the manual. scripts/build-site writes the index, `searchIndex`: sections of pages as
{page, title, heading, anchor, text, kind}; the kinds are those of docs/site/search_index.py. */
const search = (() => {
  const weights = { page: 1, python: 0.7, notebook: 0.7, history: 0.35, header: 1 };
  const labels = { page: "Manual", python: "Python", notebook: "Notebook", history: "Project", header: "C++ header" };

  const escaped = text => text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
  /* A term stands at the beginning of a word; words of names such as lift_mean_n count, and so does a plural. */
  const pattern = (term, flags) => {
    const stem = term.length > 3 ? `${escaped(term.replace(/(?<!s)s$/, ""))}s?` : escaped(term);
    return new RegExp(`(?<![\\p{L}\\p{N}])${stem}`, flags);
  };
  const common = new Set(["a", "an", "and", "are", "by", "can", "do", "does", "for", "how", "i", "in", "is", "it", "of",
    "on", "or", "the", "to", "what", "which", "with"]);
  const termsOf = query => {
    const terms = [...new Set(query.toLowerCase().match(/[\p{L}\p{N}_.-]*[\p{L}\p{N}_]/gu) ?? [])];
    const rare = terms.filter(term => !common.has(term));
    return rare.length ? rare : terms;
  };
  const occurrences = (text, found) => (text.match(found) ?? []).length;

  /* The pages for a query, best first, headers of the C++ library behind all others:
  [{page, title, kind, score, sections: [entry, ...]}]. */
  const rank = (index, query) => {
    const terms = termsOf(query);
    if (!terms.length) return [];
    const patterns = terms.map(term => pattern(term, "giu"));
    const whole = terms.map(term => new RegExp(`${pattern(term, "").source}(?![\\p{L}\\p{N}_])`, "iu"));
    const counts = index.map(entry => patterns.map(found => ({
      title: occurrences(entry.title, found), heading: occurrences(entry.heading, found),
      text: occurrences(entry.text, found)
    })));
    const rarity = terms.map((_, n) => Math.log(1 + index.length / (1 + counts.filter(
      of => of[n].title + of[n].heading + of[n].text > 0).length)));
    const length = index.reduce((sum, entry) => sum + entry.text.length, 0) / index.length;
    const phrase = terms.length > 1 ? query.trim().toLowerCase() : "";
    const pages = new Map();
    index.forEach((entry, row) => {
      let score = 0, matched = 0;
      terms.forEach((_, n) => {
        const { title, heading, text } = counts[row][n];
        if (!title && !heading && !text) return;
        ++matched;
        const dense = text / (text + 0.6 + 0.6 * entry.text.length / length);
        score += rarity[n] * (2.2 * dense + (heading ? whole[n].test(entry.heading) ? 3 : 1.8 : 0)
          + (title ? whole[n].test(entry.title) ? 2.5 : 1.5 : 0));
      });
      if (!matched) return;
      score *= (matched / terms.length) ** 3 * weights[entry.kind];
      const bare = text => text.trim().toLowerCase().replace(/s$/, "");
      const named = text => bare(text) === bare(query);
      if (named(entry.title) || named(entry.heading)) score *= 2;
      else if (phrase && `${entry.heading} ${entry.text}`.toLowerCase().includes(phrase)) score *= 1.5;
      const page = pages.get(entry.page) ?? { page: entry.page, title: entry.title, kind: entry.kind, sections: [] };
      page.sections.push({ entry, score });
      pages.set(entry.page, page);
    });
    const found = [...pages.values()].map(page => {
      page.sections.sort((a, b) => b.score - a.score);
      const rest = page.sections.slice(1, 6).reduce((sum, section) => sum + section.score, 0);
      return { ...page, score: page.sections[0].score + 0.15 * rest, sections: page.sections.map(one => one.entry) };
    });
    const last = page => page.kind === "header" ? 1 : 0;
    return found.sort((a, b) => last(a) - last(b) || b.score - a.score || (a.page < b.page ? -1 : 1));
  };

  /* A piece of `text` with as many different terms as there are: [[piece, whether it is a term], ...]. */
  const excerpt = (text, query, width = 220) => {
    const terms = termsOf(query), hits = [];
    terms.forEach((term, n) => {
      for (const hit of text.matchAll(pattern(term, "giu")))
        hits.push({ at: hit.index, end: hit.index + hit[0].length, n });
    });
    hits.sort((a, b) => a.at - b.at || b.end - a.end);
    let start = 0, best = -1;
    hits.forEach((hit, k) => {
      const kinds = new Set(), from = hit.at - 50;
      for (let m = k; m < hits.length && hits[m].end < from + width; ++m) kinds.add(hits[m].n);
      if (kinds.size > best) [best, start] = [kinds.size, Math.max(0, from)];
    });
    if (start > 0) start = text.indexOf(" ", start) + 1 || start;
    let stop = Math.min(text.length, start + width);
    if (stop < text.length) stop = Math.max(text.lastIndexOf(" ", stop), start + width / 2);
    const pieces = start > 0 ? [["… ", false]] : [];
    let at = start;
    for (const hit of hits) {
      if (hit.at < at || hit.end > stop) continue;
      if (hit.at > at) pieces.push([text.slice(at, hit.at), false]);
      pieces.push([text.slice(hit.at, hit.end), true]);
      at = hit.end;
    }
    pieces.push([text.slice(at, stop), false]);
    if (stop < text.length) pieces.push([" …", false]);
    return pieces;
  };

  /* Of the sections of a page the text that shows most of the terms. */
  const textOf = (page, query) => {
    const patterns = termsOf(query).map(term => pattern(term, "iu"));
    const shown = entry => patterns.filter(found => found.test(entry.text)).length;
    return page.sections.reduce((best, entry) => shown(entry) > shown(best) ? entry : best).text;
  };

  const make = (parent, tag, text, attributes = {}) => {
    const node = parent.appendChild(document.createElement(tag));
    if (text) node.textContent = text;
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    return node;
  };
  const marked = (parent, pieces) => pieces.forEach(([text, term]) => term ? make(parent, "mark", text)
    : parent.append(text));
  const address = entry => entry.page + (entry.anchor ? `#${encodeURIComponent(entry.anchor)}` : "");

  const showOne = (list, page, query) => {
    const item = make(list, "li"), first = page.sections[0];
    const name = first.heading && first.heading !== page.title ? `${page.title}: ${first.heading}` : page.title;
    marked(make(item, "a", "", { href: address(first) }), excerpt(name, query, 1000));
    make(item, "span", ` ${labels[page.kind]}`, { class: "where" });
    marked(make(item, "p"), excerpt(textOf(page, query), query));
    const more = page.sections.slice(1, 4).filter(entry => entry.heading && entry.heading !== first.heading);
    if (!more.length) return;
    const also = make(item, "p", "also: ", { class: "also" });
    more.forEach((entry, n) => {
      if (n) also.append(", ");
      make(also, "a", entry.heading, { href: address(entry) });
    });
  };

  const show = (query, shown = 15) => {
    const list = document.getElementById("search-results"), count = document.getElementById("search-count");
    list.replaceChildren();
    const pages = rank(searchIndex, query), headers = pages.filter(page => page.kind === "header").length;
    count.textContent = !query.trim() ? "" : pages.length
      ? `${pages.length - headers} pages and ${headers} C++ headers` : `Nothing has been found for "${query}".`;
    pages.slice(0, shown).forEach(page => showOne(list, page, query));
    if (pages.length <= shown) return;
    const more = make(make(list, "li"), "button", `${pages.length - shown} more`, { type: "button" });
    more.addEventListener("click", () => show(query, pages.length));
  };

  return { rank, excerpt, textOf, show };
})();

if (typeof document !== "undefined") {
  const query = new URLSearchParams(location.search).get("q") ?? "";
  document.getElementById("query").value = query;
  search.show(query);
}
if (typeof module !== "undefined") module.exports = search;
