// In a worker: the library as it comes, as text or bytes of an .xz file, to the bytes of the WebAssembly module.
import {XzReadableStream} from 'xz-decompress';

self.onmessage = async ({data}: MessageEvent<string | ArrayBuffer>) => {
  try {
    const packed = typeof data === 'string' ? Uint8Array.from(atob(data), (c) => c.charCodeAt(0)) : data;
    const unpacked = new XzReadableStream(new Blob([packed]).stream());
    const bytes = await new Response(unpacked).arrayBuffer();
    self.postMessage(bytes, {transfer: [bytes]});
  } catch (error) {
    self.postMessage(String(error));
  }
};
