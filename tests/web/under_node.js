// Emscripten 3.1.6 takes a `fetch` for a browser's, which reads no files here.
globalThis.fetch = undefined;
