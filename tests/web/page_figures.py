#!/usr/bin/python3
"""What the page of the viewer costs, and how good it is, in Chromium: page_figures.py BIN_DIR PAGE [SCENE ...].

For each scene: seconds until the first picture, straight from the server and over a link; pictures a second while it
plays; samples received over the link, beside framelet-client's at the same size, each viewer on one processor and the
server on another, and once more where what draws gives way to what answers, as if it had a processor of its own. With
--minutes: the memory of the page instead."""
import argparse
import contextlib
import json
import os
import pathlib
import statistics
import subprocess
import sys
import time

sys.dont_write_bytecode = True
from chromium import start_chromium

width, height = 1280, 720  # of the picture
most_seconds = 60  # until a picture is to have come
note_first_picture = ('setInterval(() => { if (window.framelet?.state.pictures > 0) '
                      'window.firstPicture ??= performance.now(); }, 5)')


class Program:
    """A program that says where it listens, and ends with the block."""

    def __init__(self, *command):
        self.process = subprocess.Popen(list(map(str, command)), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                        stderr=subprocess.DEVNULL, text=True)
        said = next((line for line in self.process.stdout if 'listening on' in line), None)
        if said is None:
            sys.exit(f'{command[0]} does not listen')
        self.port = int(said.split()[-1].rsplit(':', 1)[1])

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.communicate()


def state(browser):
    return browser.execute_script('return window.framelet?.state ?? {}')


def open_page(browser, port):
    browser.get('about:blank')
    browser.execute_cdp_cmd('Network.clearBrowserCache', {})
    browser.get(f'http://127.0.0.1:{port}/#painter=cpu')
    end = time.monotonic() + most_seconds
    while not state(browser).get('pictures'):
        if time.monotonic() > end:
            sys.exit('no picture: ' + browser.execute_script('return document.getElementById("notice")?.textContent ?? '
                                                             '"not the page but " + document.URL'))
        time.sleep(0.02)


def first_picture(browser, port, runs):
    """Seconds from the call of the address until a picture is shown, nothing of the page being there before."""
    times = []
    for _ in range(runs):
        open_page(browser, port)
        times.append(browser.execute_script('return window.firstPicture') / 1000)
    return statistics.median(times)


def rates(browser, port, seconds, prepare=lambda: None):
    """Pictures and samples a second in the page, and the size of its last picture."""
    open_page(browser, port)
    time.sleep(3)
    prepare()
    before = state(browser)
    time.sleep(seconds)
    after = state(browser)
    took = after['seconds'] - before['seconds']
    return [(after[what] - before[what]) / took for what in ('pictures', 'samples')], after['size']


def native_samples(program, port, size, seconds):
    """Samples a second that framelet-client receives, from its third second on."""
    def received(duration):
        said = subprocess.run([program, f'127.0.0.1:{port}', '--size', f'{size[0]}x{size[1]}', '--duration',
                               str(duration), '--json'], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, check=True)
        return json.loads(said.stdout)['samples']
    return (received(3 + seconds) - received(3)) / seconds


def processes_of(kind):
    """Folders in /proc of the browser's processes of this kind."""
    for process in pathlib.Path('/proc').glob('[0-9]*'):
        with contextlib.suppress(OSError):  # it has ended
            if b'--type=' + kind in (process / 'cmdline').read_bytes():
                yield process


def let_drawing_give_way():
    """Lowers the priority of the page's painter, its busiest thread, and of the process that draws the window."""
    def seconds(thread):
        fields = (thread / 'stat').read_text().rsplit(')', 1)[1].split()
        return int(fields[11]) + int(fields[12])
    threads = [thread for process in processes_of(b'renderer') for thread in (process / 'task').iterdir()]
    drawing = [thread for process in processes_of(b'gpu') for thread in (process / 'task').iterdir()]
    for thread in [max(threads, key=seconds), *drawing]:
        os.setpriority(os.PRIO_PROCESS, int(thread.name), 15)


def page_memory():
    """Bytes of the renderer that has the page, each shared one by its part."""
    most = 0
    for process in processes_of(b'renderer'):
        with contextlib.suppress(OSError):
            lines = (process / 'smaps_rollup').read_text().splitlines()
            most = max(most, next(int(line.split()[1]) for line in lines if line.startswith('Pss:')))
    return 1024 * most


def report_memory(browser, port, minutes):
    """Plays and flies around for so long; prints the memory of each tenth."""
    open_page(browser, port)
    for part in range(10):
        end = time.monotonic() + 6 * minutes
        most = 0
        while time.monotonic() < end:
            browser.execute_script('framelet.tell("orbit", 3, 0)')
            time.sleep(0.5)
            most = max(most, page_memory())
        print(f'  {minutes * (part + 1) / 10:5.1f} minutes: {most / 1e6:.0f} MB at most', flush=True)


@contextlib.contextmanager
def chromium():
    browser = start_chromium(width, height + 199)  # of which 143 are the browser's own, and 56 the page's bars
    try:
        browser.execute_cdp_cmd('Page.addScriptToEvaluateOnNewDocument', {'source': note_first_picture})
        yield browser
    finally:
        browser.quit()


@contextlib.contextmanager
def served(options, scene):
    """Ports of a server and of a link before it."""
    with Program(options.bin / 'framelet-server', scene, '--port', 0, '--insecure', '--web-files', options.page,
                 '--quiet') as server, \
            Program(options.bin / 'framelet-bench', 'link', server.port, '--bandwidth', options.bandwidth, '--delay',
                    options.delay) as link:
        yield server.port, link.port


@contextlib.contextmanager
def on_processor(number):
    """Programs that are started meanwhile have this processor alone."""
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {number})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


def report_scene(options, scene):
    print(scene.stem, flush=True)
    with served(options, scene) as (server, link), chromium() as browser:
        if options.minutes:
            report_memory(browser, server, options.minutes)
            return
        print(f'  first picture: {first_picture(browser, server, 5):.2f} s, over the link '
              f'{first_picture(browser, link, 3):.2f} s', flush=True)
        (pictures, _), size = rates(browser, server, options.seconds)
        print(f'  without a graphics card: {pictures:.1f} pictures/s of {size[0]}x{size[1]}, '
              f'{page_memory() / 1e6:.0f} MB', flush=True)
    first, second = sorted(os.sched_getaffinity(0))[:2]
    with contextlib.ExitStack() as stack:
        with on_processor(first):
            _, link = stack.enter_context(served(options, scene))
        with on_processor(second):
            with chromium() as browser:
                (_, samples), size = rates(browser, link, options.seconds)
                (_, first_served), _ = rates(browser, link, options.seconds, let_drawing_give_way)
            native = native_samples(options.bin / 'framelet-client', link, size, options.seconds)
        print(f'  over the link: {samples:.0f} samples/s, {first_served:.0f} where drawing gives way, framelet-client '
              f'{native:.0f}: {samples / native:.2f}, {first_served / native:.2f}', flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('bin', type=pathlib.Path)
    parser.add_argument('page', type=pathlib.Path)
    parser.add_argument('scenes', type=pathlib.Path, nargs='*')
    parser.add_argument('--bandwidth', type=float, default=10, help='of the link, Mbit/s')
    parser.add_argument('--delay', type=float, default=10, help='of the link, ms each way')
    parser.add_argument('--seconds', type=float, default=10, help='of each measurement')
    parser.add_argument('--minutes', type=float, default=0, help='only measure memory, for so long')
    options = parser.parse_args()
    download = sum(file.stat().st_size for file in options.page.glob('*.gz'))
    print(f'download: {download} bytes, compressed', flush=True)
    scenes = pathlib.Path(__file__).parents[2] / 'scenes'
    for scene in options.scenes or [scenes / f'{name}.glb' for name in ('windmill', 'vehicle_chase', 'foliage')]:
        report_scene(options, scene)


main()
