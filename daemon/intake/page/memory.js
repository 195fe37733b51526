// What this browser remembers of uploads that aren't finished, so that they go on after a reload. Files themselves can't be remembered:
// the user chooses them again, and they are known by path, size and SHA-256.

const kKey = "prismesh.uploads";
const kMaxRemembered = 20;

/// [{id, name, main, files: [{path, bytes, hash, upload}]}]
export function rememberedUploads() {
  try {
    const list = JSON.parse(localStorage.getItem(kKey) ?? "[]");
    return Array.isArray(list) ? list.filter((each) => Array.isArray(each?.files)) : [];
  } catch {
    return [];
  }
}

function write(list) {
  try {
    localStorage.setItem(kKey, JSON.stringify(list.slice(-kMaxRemembered)));
  } catch {
    // Without memory an upload can't go on after a reload; it goes on all the same.
  }
}

export function rememberUpload(id, upload) {
  const files = upload.files.map(({ path, file, hash, upload: at }) => ({ path, bytes: file.size, hash, upload: at }));
  write([...rememberedUploads().filter((each) => each.id !== id), { id, name: upload.name, main: upload.main, files }]);
}

export function forgetUpload(id) {
  write(rememberedUploads().filter((each) => each.id !== id));
}

/// The remembered upload of just these files. undefined: there is none.
export function rememberedUploadOf(files) {
  const key = (list) => list.map(({ path, bytes }) => `${bytes} ${path}`).sort().join("\n");
  const wanted = key(files.map(({ path, file }) => ({ path, bytes: file.size })));
  return rememberedUploads().find((each) => key(each.files) === wanted);
}

const kPaired = "prismesh.paired";

/// Whether this browser had a cookie; the cookie itself no script can see.
export function isPaired() {
  return localStorage.getItem(kPaired) !== null;
}
export function setPaired(paired) {
  if (paired) localStorage.setItem(kPaired, "yes");
  else localStorage.removeItem(kPaired);
}
