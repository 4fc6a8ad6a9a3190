// Elements of HTML and SVG in a line.
type Child = Node | string;
type Attributes = Record<string, string | number | boolean | ((event: Event) => void)>;

function fill(element: Element, attributes: Attributes, children: Child[]) {
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === 'function') element.addEventListener(name, value);
    else if (value !== false) element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children);
}

export function html<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  fill(element, attributes, children);
  return element;
}

export function svg<K extends keyof SVGElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): SVGElementTagNameMap[K] {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  fill(element, attributes, children);
  return element;
}

/** Sets attributes that are not yet so: setting one to what it is would have the browser lay out the element anew. */
export function set(element: Element, attributes: Record<string, string | number>) {
  for (const [name, value] of Object.entries(attributes)) {
    const text = String(value);
    if (element.getAttribute(name) !== text) element.setAttribute(name, text);
  }
}

/** Sets what a control shows where it is another: a browser looks through all forms of a page after each setting. */
export function setValue(control: HTMLInputElement | HTMLSelectElement, value: string) {
  if (control.value !== value) control.value = value;
}

export function byId<T extends HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found as T;
}

/**
 * Makes the children of an element equal to others, which are used up. What stays as it is is not touched, so that
 * the browser styles, lays out and paints only what changes. Not for elements with listeners, which are not compared.
 */
export function update(element: Element, children: Iterable<Node>) {
  let old = element.firstChild;
  for (const child of [...children]) {
    const next: ChildNode | null = old?.nextSibling ?? null;
    if (!old) element.append(child);
    else if (!old.isEqualNode(child)) updateNode(old, child);
    old = next;
  }
  while (old) {
    const next: ChildNode | null = old.nextSibling;
    old.remove();
    old = next;
  }
}

/** The group of this class in a picture, made where there is none. */
export function layerOf(picture: SVGSVGElement, name: string): SVGGElement {
  const known = picture.querySelector<SVGGElement>(`:scope > g.${name}`);
  if (known) return known;
  const layer = svg('g', {class: name});
  picture.append(layer);
  return layer;
}

function updateNode(old: ChildNode, wanted: Node) {
  if (old.nodeName !== wanted.nodeName) old.replaceWith(wanted);
  else if (old instanceof Element) updateElement(old, wanted as Element);
  else old.nodeValue = wanted.nodeValue;
}

function updateElement(old: Element, wanted: Element) {
  for (const name of old.getAttributeNames()) if (!wanted.hasAttribute(name)) old.removeAttribute(name);
  for (const {name, value} of wanted.attributes) if (old.getAttribute(name) !== value) old.setAttribute(name, value);
  update(old, wanted.childNodes);
}
