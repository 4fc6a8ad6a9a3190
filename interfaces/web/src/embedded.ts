// What the single file has in it in compressed form, as text elements of the page.

/** The text of the element, or null where the page is hosted in parts. */
export async function unpackedText(id: string): Promise<string | null> {
  const embedded = document.getElementById(id)?.textContent;
  if (!embedded) return null;
  const packed = Uint8Array.from(atob(embedded), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).text();
}
