#!/usr/bin/python3
"""The page in a real browser, of a real server: page_test.py SERVER CLIENT PAGE SCENE FOLDER.

FOLDER gets the screenshots. Exit code 77 where there is no browser here."""
import base64
import os
import pathlib
import shutil
import subprocess
import sys
import time
import unittest
import zlib

server_program, client_program, page, scene, folder = sys.argv[1:6]
folder = pathlib.Path(folder)
skipped = 77
try:
    from selenium import webdriver
except ImportError:
    sys.exit(print('SKIPPED: python3-selenium is missing') or skipped)
if not shutil.which('chromium') or not shutil.which('chromedriver'):
    sys.exit(print('SKIPPED: chromium or chromium-driver is missing') or skipped)

most_seconds = 120  # until something is to have come
token = 'a-token-for-the-page-test'


def make_server(port=0):
    """Starts a server, on any port or on this one; returns it and its port once it listens."""
    process = subprocess.Popen(
        [server_program, scene, '--port', str(port), '--token-file', folder / 'token', '--web-files', page],
        stdout=subprocess.PIPE, text=True)
    for line in process.stdout:
        if 'listening on' in line:
            return process, int(line.split()[-1].rsplit(':', 1)[1])
    raise RuntimeError('the server does not listen')


def read_ppm(file):
    """The pixels of a .ppm, RGB, and its width and height."""
    magic, width, height, _, pixels = file.read_bytes().split(maxsplit=4)
    assert magic == b'P6'
    return pixels, int(width), int(height)


class Page(unittest.TestCase):
    def setUp(self):
        (folder / 'token').write_text(token + '\n')
        (folder / 'token').chmod(0o600)
        self.server, self.port = make_server()
        options = webdriver.ChromeOptions()
        for option in ('--headless=new', '--no-sandbox', '--disable-gpu', '--window-size=700,500',
                       '--force-device-scale-factor=1', '--disable-dev-shm-usage'):
            options.add_argument(option)
        options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
        service = webdriver.chrome.service.Service(shutil.which('chromedriver'))
        self.browser = webdriver.Chrome(service=service, options=options)

    def tearDown(self):
        self.browser.save_screenshot(str(folder / (self._testMethodName + '.png')))
        for entry in self.browser.get_log('browser'):
            print(entry['level'], entry['message'])
        self.browser.quit()
        self.end_server()

    def end_server(self):
        self.server.kill()
        self.server.wait()
        self.server.stdout.close()

    def open(self, with_token=token):
        self.browser.get(f'http://127.0.0.1:{self.port}/#token={with_token}')

    def state(self):
        return self.browser.execute_script('return window.framelet.state')

    def notice(self):
        return self.browser.execute_script('return document.getElementById("notice").textContent')

    def wait(self, what):
        """Waits until what() is true of the state."""
        end = time.monotonic() + most_seconds
        while time.monotonic() < end:
            state = self.state()
            if what(state):
                return state
            time.sleep(0.1)
        self.fail(f'it has not come: {self.state()}, "{self.notice()}"')

    def pixels(self):
        """The canvas' pixels, RGB, and its width and height."""
        rgba, width, height = self.browser.execute_script(
            'const c = document.getElementById("picture");'
            'const p = c.getContext("2d").getImageData(0, 0, c.width, c.height).data; let text = "";'
            'for (let i = 0; i < p.length; i += 8192) text += String.fromCharCode(...p.subarray(i, i + 8192));'
            'return [btoa(text), c.width, c.height]')
        data = bytearray(base64.b64decode(rgba))
        del data[3::4]
        return bytes(data), width, height

    def click(self, name):
        self.browser.find_element('id', name).click()

    def seek(self, seconds):
        self.browser.execute_script(
            'const t = document.getElementById("time"); t.value = arguments[0];'
            't.dispatchEvent(new Event("input")); t.dispatchEvent(new Event("change"))', seconds)

    def test_still_picture_is_that_of_framelet_client(self):
        self.open()
        if self.wait(lambda s: s.get('pictures', 0) > 0)['playing']:
            self.click('play')
        self.wait(lambda s: not s['playing'])
        self.seek(0.5)
        self.wait(lambda s: s['time'] == 0.5 and s['complete'])
        pixels, width, height = self.pixels()
        self.assertGreater(width, 600)
        file = folder / 'native.ppm'
        subprocess.run([client_program, f'127.0.0.1:{self.port}', '--token-file', folder / 'token', '--size',
                        f'{width}x{height}', '--until-converged', '--output', file], check=True, timeout=most_seconds)
        native = read_ppm(file)
        self.assertEqual((width, height), native[1:])
        self.assertEqual(zlib.crc32(pixels), zlib.crc32(native[0]))
        self.assertGreater(len(set(pixels)), 20)  # it shows something

    def stand(self):
        """Stops the scene's clock and waits for a finished picture."""
        if self.wait(lambda s: s.get('pictures', 0) > 0)['playing']:
            self.click('play')
        self.wait(lambda s: not s['playing'] and s['complete'])

    def test_plays_and_pauses(self):
        self.open()
        if not self.wait(lambda s: s.get('pictures', 0) > 0)['playing']:
            self.click('play')
        before = self.wait(lambda s: s['playing'])
        self.wait(lambda s: s['time'] > before['time'] and s['pictures'] > before['pictures'] + 5)
        self.click('play')
        stood = self.wait(lambda s: not s['playing'])
        self.assertEqual(self.wait(lambda s: s['complete'])['time'], self.state()['time'])
        self.assertGreaterEqual(self.state()['time'], stood['time'])

    def test_a_drag_orbits(self):
        self.open()
        self.stand()
        before = self.pixels()[0]
        canvas = self.browser.find_element('id', 'picture')
        webdriver.ActionChains(self.browser).click_and_hold(canvas).move_by_offset(90, 20).release().perform()
        self.wait(lambda s: s['camera'] == -1 and s['complete'])
        self.assertNotEqual(before, self.pixels()[0])

    def test_exposure_makes_it_brighter(self):
        self.open()
        self.stand()
        before = sum(self.pixels()[0])
        self.browser.execute_script('const e = document.getElementById("exposure"); e.value = 2;'
                                    'e.dispatchEvent(new Event("input"))')
        end = time.monotonic() + most_seconds
        while sum(self.pixels()[0]) < 1.2 * before and time.monotonic() < end:
            time.sleep(0.2)
        self.assertGreater(sum(self.pixels()[0]), 1.2 * before)

    def test_one_finger_orbits_and_two_go_nearer_on_a_small_screen(self):
        command = self.browser.execute_cdp_cmd
        command('Emulation.setDeviceMetricsOverride', {'width': 390, 'height': 844, 'deviceScaleFactor': 1.5,
                                                       'mobile': True})
        command('Emulation.setTouchEmulationEnabled', {'enabled': True, 'maxTouchPoints': 2})
        self.open()
        self.stand()
        before, width, _ = self.pixels()
        self.assertEqual(width, 585)  # device pixels

        def touch(*moves):
            for kind, points in zip(['touchStart'] + ['touchMove'] * (len(moves) - 1), moves):
                command('Input.dispatchTouchEvent',
                        {'type': kind, 'touchPoints': [{'x': x, 'y': y, 'id': i} for i, (x, y) in enumerate(points)]})
            command('Input.dispatchTouchEvent', {'type': 'touchEnd', 'touchPoints': []})
        touch([(200, 300)], [(230, 300)], [(260, 300)])
        self.wait(lambda s: s['camera'] == -1 and s['complete'])
        orbited = self.pixels()[0]
        self.assertNotEqual(before, orbited)
        touch([(150, 300), (250, 300)], [(130, 300), (270, 300)], [(100, 300), (300, 300)])
        time.sleep(1)
        self.wait(lambda s: s['complete'])
        self.assertNotEqual(orbited, self.pixels()[0])
        self.assertLessEqual(self.browser.execute_script(
            'return document.getElementById("statistics").getBoundingClientRect().right'), 390)

    def test_finds_a_server_again_that_was_killed(self):
        self.open()
        before = self.wait(lambda s: s.get('pictures', 0) > 0)
        self.end_server()
        self.wait(lambda s: s['reason'])
        self.assertIn('trying to connect again', self.notice())
        self.server, _ = make_server(self.port)
        after = self.wait(lambda s: not s['reason'] and s['reconnections'] > before['reconnections'])
        self.wait(lambda s: s['samples'] > after['samples'])

    def test_a_wrong_token_is_refused_for_good(self):
        self.open('another')
        self.assertTrue(self.wait(lambda s: s.get('reason'))['refused'])
        self.assertIn('token', self.notice())
        self.assertNotIn('again', self.notice())


if __name__ == '__main__':
    os.makedirs(folder, exist_ok=True)
    unittest.main(argv=sys.argv[:1] + sys.argv[6:], verbosity=2)
