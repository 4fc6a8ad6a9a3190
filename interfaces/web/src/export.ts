// Pictures and numbers as files.
import type {Columns} from './core';

export function download(name: string, content: BlobPart, type: string) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([content], {type}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

const drawn = [
  'fill',
  'stroke',
  'stroke-width',
  'stroke-dasharray',
  'stroke-linecap',
  'stroke-linejoin',
  'opacity',
  'fill-opacity',
  'paint-order',
  'font-size',
  'font-family',
  'font-weight',
];

/** The picture as a file of its own: what the page's style gives each element becomes an attribute. */
export function standalone(picture: SVGSVGElement): string {
  const copy = picture.cloneNode(true) as SVGSVGElement;
  const [, , width, height] = (picture.getAttribute('viewBox') ?? '0 0 400 300').split(' ').map(Number);
  const originals = picture.querySelectorAll('*'),
    live = copy.querySelectorAll('.live'); // of one instant
  copy.querySelectorAll('*').forEach((element, n) => {
    const style = getComputedStyle(originals[n]!);
    for (const name of drawn) element.setAttribute(name, style.getPropertyValue(name));
    element.removeAttribute('class');
  });
  for (const element of live) element.remove();
  const paper = document.createElementNS('http://www.w3.org/2000/svg', 'rect');
  for (const [name, value] of Object.entries({width, height, fill: getComputedStyle(document.body).backgroundColor})) {
    paper.setAttribute(name, String(value));
  }
  copy.prepend(paper);
  for (const [name, value] of Object.entries({xmlns: 'http://www.w3.org/2000/svg', width, height}))
    copy.setAttribute(name, String(value));
  return new XMLSerializer().serializeToString(copy);
}

export const saveSvg = (name: string, picture: SVGSVGElement) =>
  download(`${name}.svg`, standalone(picture), 'image/svg+xml');

export async function savePng(name: string, picture: SVGSVGElement, scale = 2) {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(standalone(picture))}`;
  await image.decode();
  const canvas = document.createElement('canvas');
  canvas.width = image.width * scale;
  canvas.height = image.height * scale;
  canvas.getContext('2d')?.drawImage(image, 0, 0, canvas.width, canvas.height);
  const blob = await new Promise<Blob | null>((done) => canvas.toBlob(done, 'image/png'));
  if (blob) download(`${name}.png`, blob, 'image/png');
}

/** The cycle as `wingbeat run --waveforms` writes it. */
export function cycleCsv(columns: Columns): string {
  const names = Object.keys(columns),
    all = Object.values(columns);
  const written = (x: number | undefined) => (Number.isFinite(x) ? String(x) : '');
  const rows = Array.from(all[0] ?? [], (_, row) => all.map((numbers) => written(numbers[row])).join(','));
  return [names.join(','), ...rows].join('\n') + '\n';
}
