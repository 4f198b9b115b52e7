// The session's thread: socket, core and painter. From the page: what the user does, and a request for each picture. To
// the page: pictures with their state.
'use strict';

const silenceSeconds = 5; // a server says something every second
let socket = null;
let heard = 0; // when something came last, milliseconds
let core = null;
let exposure = 0;
let paused = false;

var Module = {
    send: bytes => socket.send(bytes),
    onRuntimeInitialized: () => {
        const call = (name, result, ...types) => Module.cwrap('page_' + name, result, types);
        core = {
            begin: call('begin', null, 'string'), open: call('open', null), receive: call('receive', 'boolean',
                'number', 'number'), noteSent: call('note_sent', null, 'boolean'),
            close: call('close', 'number', 'string', 'number'), paint: call('paint', 'boolean', 'number', 'number'),
            pixels: call('pixels', 'number'), width: call('width', 'number'), height: call('height', 'number'),
            state: call('state', 'string'), settings: call('settings', null, 'number', 'boolean'),
        };
        for (const [name, ...types] of [['orbit', 'number', 'number'], ['pan', 'number', 'number'],
            ['dolly', 'number'], ['fit'], ['focus', 'number', 'number'], ['camera', 'number'], ['play', 'boolean'],
            ['seek', 'number']]) {
            does[name] = call(name, null, ...types);
        }
        postMessage({ready: true});
    },
};

const does = {
    begin: (token, address) => {
        core.begin(token);
        connect(address);
    },
    exposure: stops => {
        exposure = stops;
        core.settings(exposure, paused);
    },
    pause: now => {
        paused = now;
        core.settings(exposure, paused);
    },
    paint,
};

function connect(address) {
    const mine = new WebSocket(address);
    socket = mine;
    mine.binaryType = 'arraybuffer';
    heard = performance.now();
    const watch = setInterval(() => {
        if (performance.now() - heard > 1000 * silenceSeconds) {
            end('the server is silent');
        }
    }, 1000);
    function end(reason) {
        if (socket !== mine) {
            return;
        }
        socket = null;
        clearInterval(watch);
        mine.close();
        const seconds = core.close(reason, Math.random());
        if (seconds >= 0) {
            setTimeout(connect, 1000 * seconds, address);
        }
    }
    mine.onopen = () => core.open();
    mine.onmessage = event => {
        if (socket !== mine) {
            return;
        }
        heard = performance.now();
        const bytes = new Uint8Array(event.data);
        const place = Module._malloc(bytes.length);
        HEAPU8.set(bytes, place);
        const isWell = core.receive(place, bytes.length);
        Module._free(place);
        if (!isWell) {
            end('');
        }
        core.noteSent(mine.bufferedAmount === 0);
    };
    mine.onclose = () => end('the server is gone');
}

function paint(width, height) {
    core.noteSent(socket === null || socket.bufferedAmount === 0);
    const answer = {state: null, picture: null};
    if (core.paint(width, height)) {
        const size = [core.width(), core.height()];
        const begin = core.pixels();
        const pixels = new Uint8ClampedArray(HEAPU8.slice(begin, begin + 4 * size[0] * size[1]).buffer);
        answer.picture = {pixels, width: size[0], height: size[1]};
    }
    answer.state = JSON.parse(core.state());
    postMessage(answer, answer.picture ? [answer.picture.pixels.buffer] : []);
}

onmessage = event => core && does[event.data[0]](...event.data.slice(1)); // the page begins once it is ready
importScripts('framelet.js');
