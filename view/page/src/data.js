// The data of the page: chunks in script elements, each base64 of what zlib compressed. The first is
// JSON that says what the others are. view/page_data.h is the writer.

const kBytes = { u8: 1, u16: 2, u32: 4, i32: 4, f32: 4 };
const kMostKept = 256e6;
const kArrays = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, i32: Int32Array, f32: Float32Array };

function bytesOfBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let n = 0; n < bytes.length; ++n) bytes[n] = binary.charCodeAt(n);
  return bytes;
}

async function inflate(bytes) {
  if (typeof DecompressionStream === "undefined") {
    throw new Error("This browser is too old to unpack the page; one of 2023 or later opens it");
  }
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

/// Numbers whose first bytes stand together, then the second ones, and so on.
function fromPlanes(bytes, type, count) {
  const width = kBytes[type];
  const out = new Uint8Array(count * width);
  for (let byte = 0; byte < width; ++byte) {
    for (let n = 0; n < count; ++n) out[n * width + byte] = bytes[byte * count + n];
  }
  return new kArrays[type](out.buffer);
}

export class PageData {
  constructor(elements) {
    this.elements = [...elements];
    // The oldest is forgotten first, and unpacked again when somebody comes back to it.
    this.unpacked = new Map();
    this.kept = 0;
    this.onProgress = () => {};
    this.wanted = 0;
    this.done = 0;
  }

  async unpack(number) {
    return inflate(bytesOfBase64(this.elements[number].textContent));
  }

  async manifest() {
    return JSON.parse(new TextDecoder().decode(await this.unpack(0)));
  }

  /// The arrays of a chunk by name, which nobody may change. Several parts of a view may ask for a chunk
  /// at once, so that it is the promise that is kept.
  arrays(reference) {
    const { chunk, bytes } = reference;
    const found = this.unpacked.get(chunk) ?? { promise: this.load(reference), bytes };
    if (!this.unpacked.delete(chunk)) this.kept += bytes;
    this.unpacked.set(chunk, found);
    for (const [oldest, one] of this.unpacked) {
      if (this.kept <= kMostKept || oldest === chunk) break;
      this.unpacked.delete(oldest);
      this.kept -= one.bytes;
    }
    return found.promise;
  }

  async load(reference) {
    this.wanted += reference.bytes;
    this.onProgress(this.done / this.wanted);
    // Chunk 0 is the manifest.
    const buffer = await this.unpack(reference.chunk + 1);
    const arrays = {};
    for (const [name, type, at, count] of reference.arrays) {
      const plain = type.replace("p", "");
      arrays[name] = type === plain
        ? new kArrays[type](buffer, at, count)
        : fromPlanes(new Uint8Array(buffer, at, count * kBytes[plain]), plain, count);
    }
    this.done += reference.bytes;
    this.onProgress(this.done / this.wanted);
    return arrays;
  }
}
