"""What cases of the page stand on: a real browser, a real server, and what is said to either.

The program is called as page_test.py says. Exit code 77 where there is no browser here."""
import base64
import json
import math
import pathlib
import re
import subprocess
import sys
import time
import unittest
import zlib

server_program, client_program, page, scene, folder = sys.argv[1:6]
folder = pathlib.Path(folder)
skipped = 77
most_seconds = 120  # until something is to have come
token = 'a-token-for-the-page-test'


def skip(why):
    """Ends the program: there is no browser here."""
    sys.exit(print('SKIPPED:', why) or skipped)


def read_ppm(file):
    """The pixels of a .ppm, RGB, and its width and height."""
    header = re.match(rb'P6\s+(\d+)\s+(\d+)\s+255\s', data := file.read_bytes())
    return data[header.end():], int(header[1]), int(header[2])


def decibels(one, other):
    """PSNR of pictures of one size."""
    assert len(one) == len(other)
    squares = sum((a - b) ** 2 for a, b in zip(one, other))
    return 99 if squares == 0 else 10 * math.log10(255 * 255 * len(one) / squares)


class PageCase(unittest.TestCase):
    """`start_browser` gives a browser with what it is asked here of selenium's drivers."""
    server = None  # that the cases have in common

    @classmethod
    def setUpClass(cls):
        folder.mkdir(parents=True, exist_ok=True)
        (folder / 'token').write_text(token + '\n')
        (folder / 'token').chmod(0o600)
        cls.browser = cls.start_browser()

    @classmethod
    def tearDownClass(cls):
        cls.browser.quit()
        cls.end_server()

    @classmethod
    def start_server(cls, *options, port=0, log=None):
        """Starts a server in the place of the one before, on any port or on this one, and waits until it listens. Its
        log goes to a file, if anywhere. It is there for the cases that follow, too, unless it is an unusual one."""
        cls.end_server()
        cls.server = subprocess.Popen(
            [server_program, scene, '--port', str(port), '--token-file', folder / 'token', '--web-files', page,
             *([] if log else ['--quiet']), *options],
            stdout=subprocess.PIPE, stderr=log, text=True)
        cls.is_unusual = bool(options or log)
        said = next((line for line in cls.server.stdout if 'listening on' in line), None)
        if said is None:
            raise RuntimeError('the server does not listen')
        cls.port = int(said.split()[-1].rsplit(':', 1)[1])

    @classmethod
    def end_server(cls):
        if cls.server:
            cls.server.kill()
            cls.server.wait()
            cls.server.stdout.close()
            cls.server = None

    def setUp(self):
        self.begun = time.monotonic()
        self.browser.set_window_size(520, 400)
        if not self.server:
            self.start_server()

    def tearDown(self):
        self.browser.save_screenshot(str(folder / (self._testMethodName + '.png')))
        for entry in self.browser.get_log('browser'):
            if 'ERR_CONNECTION_REFUSED' not in entry['message']:
                print(entry['level'], entry['message'])
        self.browser.execute_script('try { localStorage.clear(); } catch {}')  # a page that was not loaded has none
        self.leave()
        if self.is_unusual:
            self.end_server()
        print(f'{time.monotonic() - self.begun:.1f} s', end=' ')

    def leave(self):
        self.browser.get('about:blank')

    def open(self, with_token=token, more=''):
        self.browser.get(f'http://127.0.0.1:{self.port}/#token={with_token}{more}')

    def stand(self):
        """Stops the scene's clock and waits for a finished picture."""
        if self.wait(lambda s: s.get('pictures', 0) > 0)['playing']:
            self.click('play')
        self.finish(lambda s: not s['playing'])

    def state(self):
        return self.browser.execute_script('return window.framelet?.state ?? {}')  # a page that loads has none

    def notice(self):
        """What the page says large, or, where the browser shows no such page, what it shows and how that came."""
        return self.browser.execute_script(
            'return document.getElementById("notice")?.textContent ?? `${document.URL} '
            '${JSON.stringify(performance.getEntriesByType("navigation"))} ${document.documentElement.outerHTML}`')

    def note(self):
        return self.browser.execute_script('return document.getElementById("note").textContent')

    def view(self):
        return json.loads(self.browser.execute_async_script('window.framelet.ask("view").then(arguments[0])'))

    def wait_for(self, get, what):
        """Waits until what() is true of what get() gives."""
        end = time.monotonic() + most_seconds
        while time.monotonic() < end:
            if what(got := get()):
                return got
            time.sleep(0.1)
        self.fail(f'it has not come: {str(got)[:2000]}, "{self.notice()[:4000]}"')

    def wait(self, what):
        """Waits until what() is true of the state."""
        return self.wait_for(self.state, what)

    def finish(self, what=lambda s: True):
        """Waits likewise, and for a finished picture of the whole size: in motion it may have half of it."""
        return self.wait(lambda s: what(s) and s['complete'] and s['size'][0] == self.width())

    def width(self):
        """That a whole picture has, pixels; a page that loads has none."""
        return self.browser.execute_script(
            'return Math.round(document.getElementById("view")?.getBoundingClientRect().width * devicePixelRatio)')

    def rest(self, *figures, seconds=0.5):
        """Waits until these figures of the state have stood for so long."""
        def rests():
            before = self.state()
            time.sleep(seconds)
            after = self.state()
            return all(before[figure] == after[figure] for figure in figures)
        self.wait_for(rests, bool)

    def wait_for_view(self, what):
        return self.wait_for(self.view, what)

    def wait_for_other_pixels(self, before):
        """Waits until the painter's picture is another than this one; returns it."""
        return self.wait_for(lambda: self.pixels()[0], lambda pixels: pixels != before)

    def pixels(self):
        """The newest picture's pixels, RGB, its width and height, from its painter: the screen follows later."""
        return self.read_pixels('framelet.ask("picture").then(createImageBitmap).then(read)')

    def pixels_on_screen(self):
        return self.read_pixels('read(document.getElementById("picture"))')

    def read_pixels(self, script):
        rgba, width, height = self.browser.execute_async_script(
            'const done = arguments[0]; const read = from => { const c = document.createElement("canvas");'
            '[c.width, c.height] = [from.width, from.height]; c.getContext("2d").drawImage(from, 0, 0);'
            'const p = c.getContext("2d").getImageData(0, 0, c.width, c.height).data; let text = "";'
            'for (let i = 0; i < p.length; i += 8192) text += String.fromCharCode(...p.subarray(i, i + 8192));'
            'done([btoa(text), c.width, c.height]); };' + script)
        data = bytearray(base64.b64decode(rgba))
        del data[3::4]
        return bytes(data), width, height

    def click(self, name):
        self.browser.find_element('id', name).click()

    def still_picture_is_that_of_framelet_client(self, painter):
        self.open(more='&painter=' + painter)
        if self.wait(lambda s: s.get('pictures', 0) > 0)['playing']:
            self.click('play')
        self.wait(lambda s: not s['playing'])
        self.seek(0.5)
        self.finish(lambda s: s['time'] == 0.5)
        pixels, width, height = self.pixels()
        self.assertGreater(width, 500)
        file = folder / 'native.ppm'
        subprocess.run([client_program, f'127.0.0.1:{self.port}', '--token-file', folder / 'token', '--size',
                        f'{width}x{height}', '--until-converged', '--output', file], check=True, timeout=most_seconds,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        native = read_ppm(file)
        self.assertEqual((width, height), native[1:])
        self.assertEqual(zlib.crc32(pixels), zlib.crc32(native[0]))
        self.assertGreater(len(set(pixels)), 20)  # it shows something

    def seek(self, seconds):
        self.browser.execute_script(
            'const t = document.getElementById("time"); t.value = arguments[0];'
            't.dispatchEvent(new Event("input")); t.dispatchEvent(new Event("change"))', seconds)

    def tell(self, *message):
        """Tells the painter something, as the page's controls do."""
        self.browser.execute_script('window.framelet.tell(...arguments)', *message)

    def draw_over(self, name):
        self.browser.execute_script('const o = document.getElementById("overlay"); o.value = arguments[0];'
                                    'o.dispatchEvent(new Event("change"))', name)


def run_cases():
    """Runs the cases that are named, or all, and once more those that fail, in a new browser: the exit code is that of
    what fails twice. A browser and its driver lose a page or a click now and then; what failed is printed each time."""
    run = lambda names: unittest.main('__main__', argv=[sys.argv[0], *names], verbosity=2, exit=False).result
    first = run(sys.argv[6:])
    if first.wasSuccessful():
        return
    failed = [case for case, _ in first.failures + first.errors]
    are_cases = all(isinstance(case, unittest.TestCase) for case in failed)
    names = [case.id().removeprefix('__main__.') for case in failed] if are_cases else sys.argv[6:]
    print('AGAIN, as it failed:', *names, file=sys.stderr)
    sys.exit(not run(names).wasSuccessful())
