// Starts a thread's own instance of the core, from the module that the page has compiled once.
'use strict';

/// `send` is called with bytes for the server. Resolves once `call(NAME, RESULT, ...TYPES)` makes functions.
function startModule(module, send) {
    return new Promise(resolve => {
        self.Module = {
            send,
            instantiateWasm: (imports, done) => {
                WebAssembly.instantiate(module, imports).then(instance => done(instance, module));
                return {};
            },
            onRuntimeInitialized: () => resolve(wrapped),
        };
        importScripts('framelet.js');
    });
}

/// Makes a function of the module's `page_NAME`, which takes one text at most. That lies on the heap: cwrap would put
/// it on the stack, which has no room for whatever an address or the browser's storage has.
function wrapped(name, result, ...types) {
    const call = Module.cwrap('page_' + name, result, types.map(type => type === 'string' ? 'number' : type));
    const text = types.indexOf('string');
    return text < 0 ? call : (...values) => withBytes(new TextEncoder().encode(values[text] + '\0'), place => {
        values[text] = place;
        return call(...values);
    });
}

/// Calls `use(ADDRESS, LENGTH)` with the bytes in the instance's memory.
function withBytes(bytes, use) {
    const place = Module._malloc(bytes.length);
    HEAPU8.set(bytes, place);
    const result = use(place, bytes.length);
    Module._free(place);
    return result;
}
