// The data of the page: a JSON tree whose arrays are slices of one gzipped block of bytes.

const TYPES = { f4: Float32Array, i4: Int32Array, u1: Uint8Array };

/** Reads the elements #tree and #bytes. */
export async function read() {
  const tree = JSON.parse(document.getElementById("tree").textContent);
  const packed = Uint8Array.from(
    atob(document.getElementById("bytes").textContent.trim()),
    (letter) => letter.charCodeAt(0),
  );
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  const bytes = await new Response(stream).arrayBuffer();
  return revived(tree, bytes);
}

/** The tree with { "$array": [type, offset in bytes, length] } replaced by typed arrays. */
function revived(tree, bytes) {
  if (Array.isArray(tree)) return tree.map((item) => revived(item, bytes));
  if (tree === null || typeof tree !== "object") return tree;
  if ("$array" in tree) {
    const [type, offset, length] = tree.$array;
    return new TYPES[type](bytes, offset, length);
  }
  return Object.fromEntries(Object.entries(tree).map(([key, item]) => [key, revived(item, bytes)]));
}

/** Index of the last entry of a sorted array that is <= value; 0 if there is none. */
export function rowAt(sorted, value) {
  let low = 0;
  let high = sorted.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (sorted[middle] <= value) low = middle;
    else high = middle - 1;
  }
  return low;
}
