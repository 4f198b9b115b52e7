// The network's thread: the socket, and the answer to each batch when it arrives. From the page: how to begin. To the
// painter and from it: bytes. Bytes of a socket that has been closed go nowhere: each socket has a number.
'use strict';

const gone = 'the server is gone';
const silenceSeconds = 5; // a server says something every second
const mostAhead = 16e6; // bytes that the painter has not taken: beyond it answers wait, and so does the server
let socket = null;
let number = 0; // of the socket
let silentSeconds = 0; // counted, so that a machine that slept hears what came meanwhile
let ahead = 0; // bytes
let heldBack = []; // answers
let unsent = 0; // the painter's frames, of which it is to be told when the socket has taken them
let address = null;
let painter = null; // its port
let core = null;

onmessage = async event => {
    const {module, port, url} = event.data;
    [painter, address] = [port, url];
    const call = await startModule(module, bytes => ahead > mostAhead ? heldBack.push(bytes) : socket.send(bytes));
    core = {
        answerAnew: call('answer_anew', null), sayGoodbye: call('say_goodbye', null),
        answer: call('answer', null, 'number', 'number', 'number'),
    };
    onmessage = leave;
    painter.onmessage = message => does[message.data[0]](...message.data.slice(1));
    connect();
};

const does = {
    send: (of, bytes) => {
        ++unsent;
        if (of === number && socket !== null) {
            socket.send(bytes);
        }
        tellSent();
    },
    taken: (of, size) => {
        ahead -= of === number ? size : 0;
        if (ahead <= mostAhead && socket !== null) {
            heldBack.splice(0).forEach(bytes => socket.send(bytes));
        }
    },
    end: of => of === number && end(''),
    retry: seconds => setTimeout(connect, 1000 * seconds),
};

function tellSent() {
    if (socket !== null && socket.bufferedAmount > 0) {
        setTimeout(tellSent, 5);
    } else if (unsent > 0) {
        painter.postMessage(['sent', unsent]);
        unsent = 0;
    }
}

function end(reason) {
    if (socket !== null) {
        socket.close();
        socket = null;
        painter.postMessage(['closed', reason]);
    }
}

function leave() {
    if (socket !== null && socket.readyState === WebSocket.OPEN) {
        heldBack = [];
        ahead = 0;
        core.sayGoodbye();
    }
}

function connect() {
    const mine = new WebSocket(address);
    socket = mine;
    ++number;
    silentSeconds = ahead = 0;
    heldBack = [];
    core.answerAnew();
    mine.binaryType = 'arraybuffer';
    let isOpen = false;
    mine.onopen = () => {
        isOpen = true;
        socket === mine && painter.postMessage(['open', number]);
    };
    mine.onmessage = event => {
        if (socket !== mine) {
            return;
        }
        const now = performance.now();
        silentSeconds = 0;
        ahead += event.data.byteLength;
        withBytes(new Uint8Array(event.data), (place, size) => core.answer(place, size, now));
        painter.postMessage(['bytes', event.data], [event.data]);
    };
    mine.onclose = async () => {
        const reason = isOpen ? gone : await reasonNotOpened();
        socket === mine && end(reason);
    };
}

/// Why a socket was not opened: browsers do not say. To a page that it does not let in the server says so.
async function reasonNotOpened() {
    try {
        const answer = await fetch(address.replace(/^ws/, 'http'),
                                   {method: 'POST', signal: AbortSignal.timeout(1000 * silenceSeconds)});
        return answer.status === 403 ? 'the server does not let this page in: ' + (await answer.text()).trim() : gone;
    } catch {
        return gone;
    }
}

setInterval(() => {
    if (++silentSeconds > silenceSeconds) {
        end('the server is silent');
    }
}, 1000);
importScripts('module.js');
