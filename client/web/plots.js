// The course of the page's figures over the last ten seconds. In: the painter's state, again and again. Out: small
// plots on a canvas, one below the other, and the figures in words for who does not see them.
'use strict';

const plots = (() => {
    const [shownSeconds, interval, meanSeconds] = [10, 0.25, 1]; // figures are means over the last second
    const [width, rowHeight, textHeight] = [220, 46, 18]; // CSS pixels
    const rows = [
        {unit: 'pictures/s', color: '#8fd3ff', of: (pictures, making, bytes, seconds) => pictures / seconds},
        {unit: 'ms a picture', color: '#ffd27f', of: (pictures, making) => pictures ? 1000 * making / pictures : NaN},
        {unit: 'kB/s', color: '#a8e6a1', of: (pictures, making, bytes, seconds) => bytes / 1000 / seconds},
    ];
    const canvas = document.getElementById('plots');
    let taken = []; // counts so far, and figures; the oldest first

    const textOf = (row, value) => (Number.isNaN(value) ? '-' : value.toFixed(0)) + ' ' + row.unit;

    function drawRow(context, row, i, now) {
        const top = i * rowHeight;
        const values = taken.map(at => at.values[i]);
        const most = Math.max(...values.filter(value => !Number.isNaN(value)), 1e-6);
        context.fillStyle = context.strokeStyle = row.color;
        context.fillText(textOf(row, values[values.length - 1]), 6, top + textHeight - 4);
        context.beginPath();
        let isDown = false; // the pen: a figure that there is not leaves a gap
        taken.forEach(({time}, n) => {
            const at = [width * (1 - (now - time) / shownSeconds), top + rowHeight - 3
                - (rowHeight - textHeight - 4) * values[n] / most];
            Number.isNaN(values[n]) ? isDown = false : isDown ? context.lineTo(...at) : context.moveTo(...at);
            isDown = !Number.isNaN(values[n]);
        });
        context.stroke();
    }

    /// Draws them where they are shown.
    function draw() {
        if (canvas.hidden || taken.length === 0) {
            return;
        }
        [canvas.width, canvas.height] = [width, rows.length * rowHeight].map(side => side * devicePixelRatio);
        const context = canvas.getContext('2d');
        context.scale(devicePixelRatio, devicePixelRatio);
        context.font = '12px system-ui, sans-serif';
        const newest = taken[taken.length - 1];
        rows.forEach((row, i) => drawRow(context, row, i, newest.time));
        canvas.setAttribute('aria-label', rows.map((row, i) => textOf(row, newest.values[i])).join(', '));
    }

    /// Takes a state at this time, seconds: also while nobody looks, since plots show what was before.
    function note({pictures, bytes, reconstruct_seconds: making}, time) {
        if (taken.length > 0 && time - taken[taken.length - 1].time < interval) {
            return;
        }
        const to = {time, pictures, making, bytes};
        const from = taken.find(at => time - at.time <= meanSeconds) ?? taken[taken.length - 1] ?? to;
        const since = ['pictures', 'making', 'bytes', 'time'].map(count => to[count] - from[count]);
        to.values = rows.map(row => from === to ? NaN : row.of(...since));
        taken = taken.filter(at => time - at.time <= shownSeconds).concat(to);
        draw();
    }
    return {note, draw};
})();
