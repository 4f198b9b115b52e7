#!/usr/bin/python3
"""The page in Chromium, of a real server: page_test.py SERVER CLIENT PAGE SCENE FOLDER [Page.test_NAME ...].

FOLDER gets the screenshots. Exit code 77 where there is no browser here."""
import contextlib
import http.server
import json
import math
import re
import shutil
import socket
import subprocess
import sys
import threading
import time
import unittest

sys.dont_write_bytecode = True
from page_case import PageCase, client_program, decibels, folder, most_seconds, read_ppm, run_cases, skip, token
try:
    from chromium import start_chromium
    from selenium import webdriver
    from selenium.webdriver.common.keys import Keys
except ImportError as error:
    skip(error)


class Around(http.server.BaseHTTPRequestHandler):
    """A page that has the viewer in it, of the server whose port stands behind its #."""

    def do_GET(self):
        self.send_response(200)
        self.send_header('Content-Type', 'text/html')
        self.end_headers()
        self.wfile.write(b'<iframe width=500 height=300></iframe><script>document.querySelector("iframe").src ='
                         b'`http://127.0.0.1:${location.hash.slice(1)}/?ui=none#token=' + token.encode() +
                         b'`</script>')

    def log_message(self, *_):
        pass


def make_renaming_proxy(port):
    """Starts a proxy that calls this server by another name than the browser does; returns its port."""
    listening = socket.create_server(('127.0.0.1', 0))

    def pump(source, sink, change):
        with contextlib.suppress(OSError):
            while data := source.recv(65536):
                sink.sendall(change(data))
            sink.shutdown(socket.SHUT_WR)

    def relay(here):
        with here, socket.create_connection(('127.0.0.1', port)) as there:
            back = threading.Thread(target=pump, args=(there, here, lambda data: data), daemon=True)
            back.start()
            pump(here, there, lambda data: data.replace(b'Host: 127.0.0.1', b'Host: localhost'))
            back.join()

    def serve():
        with listening:
            while True:
                threading.Thread(target=relay, args=(listening.accept()[0],), daemon=True).start()
    threading.Thread(target=serve, daemon=True).start()
    return listening.getsockname()[1]


class Page(PageCase):
    @classmethod
    def start_browser(cls):
        return start_chromium(520, 400)

    def keys(self, action):
        """Does ActionChains with the view in focus."""
        self.browser.execute_script('document.getElementById("view").focus()')
        action(webdriver.ActionChains(self.browser)).perform()

    def emulate(self, width, height, scale):
        """Makes the browser one of a touch screen, until the case ends."""
        command = self.browser.execute_cdp_cmd
        command('Emulation.setDeviceMetricsOverride', {'width': width, 'height': height, 'deviceScaleFactor': scale,
                                                       'mobile': True})
        command('Emulation.setTouchEmulationEnabled', {'enabled': True, 'maxTouchPoints': 2})
        self.addCleanup(command, 'Emulation.setTouchEmulationEnabled', {'enabled': False})
        self.addCleanup(command, 'Emulation.clearDeviceMetricsOverride', {})

    def touch(self, *moves):
        """Lays fingers on the screen at the first places, moves them to the others, and lifts them."""
        command = self.browser.execute_cdp_cmd
        for kind, points in zip(['touchStart'] + ['touchMove'] * (len(moves) - 1), moves):
            command('Input.dispatchTouchEvent',
                    {'type': kind, 'touchPoints': [{'x': x, 'y': y, 'id': i} for i, (x, y) in enumerate(points)]})
        command('Input.dispatchTouchEvent', {'type': 'touchEnd', 'touchPoints': []})

    def tap(self, name):
        box = self.browser.find_element('id', name).rect
        self.touch([(box['x'] + box['width'] / 2, box['y'] + box['height'] / 2)])

    def test_still_picture_is_that_of_framelet_client(self):
        self.still_picture_is_that_of_framelet_client('auto')
        self.assertEqual(self.state()['painter'], 'processor')  # here OpenGL is a program

    def test_still_picture_on_webgl_is_that_of_framelet_client(self):
        self.browser.set_window_size(520, 340)
        self.still_picture_is_that_of_framelet_client('gpu')
        self.assertTrue(self.state()['painter'].startswith('OpenGL'), self.state()['painter'])
        on_webgl = self.pixels()
        before = self.state()['pictures']
        self.tell('painter', 'cpu')  # as where the graphics card gives up: a new canvas, though nothing has changed
        self.wait(lambda s: s['painter'] == 'processor' and s['pictures'] > before)
        self.assertEqual(self.pixels(), on_webgl)

    def test_webgl_moves_samples_as_the_processor_does(self):
        self.browser.set_window_size(520, 340)
        self.open(more='&painter=gpu')
        self.stand()
        still = self.pixels()[0]
        self.tell('pause', True)  # nothing comes for the camera that follows: what is held is moved
        self.rest('samples')
        self.tell('orbit', 20, 5)
        self.wait(lambda s: s['camera'] == -1)
        self.rest('samples', 'pictures')
        self.assertTrue(self.state()['painter'].startswith('OpenGL'), self.state()['painter'])
        on_webgl = self.pixels()[0]
        before = self.state()['pictures']
        self.tell('painter', 'cpu')
        self.wait(lambda s: s['painter'] == 'processor' and s['pictures'] > before)
        self.rest('samples', 'pictures')
        on_processor = self.pixels()[0]
        self.assertLess(decibels(still, on_processor), 40)
        self.assertGreaterEqual(decibels(on_webgl, on_processor), 55)

    def test_half_the_size_where_the_processor_is_too_slow(self):
        self.browser.set_window_size(2000, 1400)
        self.open(more='&painter=cpu')
        if not self.wait(lambda s: s.get('pictures', 0) > 0)['playing']:
            self.click('play')
        width = self.browser.execute_script('return document.getElementById("view").clientWidth')
        self.assertGreater(width, 1900)
        of_canvas = 'return document.getElementById("picture").width'
        self.wait(lambda s: self.browser.execute_script(of_canvas) == width // 2)
        self.click('play')
        self.wait(lambda s: self.browser.execute_script(of_canvas) == width)

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
        view = self.browser.find_element('id', 'view')
        webdriver.ActionChains(self.browser).click_and_hold(view).move_by_offset(90, 20).release().perform()
        self.wait(lambda s: s['camera'] == -1)
        self.wait_for_other_pixels(before)

    def test_an_address_keeps_a_view_that_framelet_client_takes_too(self):
        self.browser.set_window_size(520, 340)
        self.open()
        self.stand()
        self.tell('orbit', 60, 15)
        self.tell('seek', 1.25)
        self.tell('exposure', 1)
        self.finish(lambda s: s['camera'] == -1 and s['time'] == 1.25 and s['exposure'] == 1)
        self.click('link')
        address = self.wait_for(lambda: self.browser.execute_script('return location.href'), lambda a: 'camera=' in a)
        before, width, height = self.pixels()
        file = folder / 'linked.ppm'
        subprocess.run([client_program, f'127.0.0.1:{self.port}', '--token-file', folder / 'token', '--size',
                        f'{width}x{height}', '--camera', address, '--until-converged', '--output', file], check=True,
                       timeout=most_seconds, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.assertGreater(decibels(before, read_ppm(file)[0]), 45)  # the text has the camera but for rounding
        self.leave()
        self.browser.get(address)
        self.finish(lambda s: s.get('camera') == -1 and s['time'] == 1.25 and s['exposure'] == 1)
        self.assertGreater(decibels(before, self.pixels()[0]), 45)

    def test_a_view_that_is_none_is_said_to_be(self):
        self.open(more='&camera=%7B%7D')
        self.wait_for(self.note, lambda said: '"position" is missing' in said)

    def way_ahead(self, before, after):
        """How far the second view's camera is ahead of the first one's, metres."""
        return sum((t - p) * (q - p) for t, p, q in zip(before['target'], before['position'], after['position']))

    def test_keys_fly_and_show_standard_views(self):
        self.open()
        self.wait(lambda s: s.get('pictures', 0) > 0)
        before = self.view()
        self.keys(lambda k: k.key_down('w').pause(0.6).key_up('w'))
        self.wait_for_view(lambda v: self.way_ahead(before, v) > 0.1)
        self.wait_for(lambda: (self.view()['position'], time.sleep(0.2), self.view()['position']),
                      lambda places: places[0] == places[2])  # the key is up
        self.keys(lambda k: k.send_keys(Keys.NUMPAD7))
        above = self.wait_for_view(lambda v: abs(v['up'][2] + 1) < 1e-3)
        self.assertGreater(above['position'][1], above['target'][1])
        self.keys(lambda k: k.send_keys('1'))
        self.wait(lambda s: s['camera'] == 0)
        self.keys(lambda k: k.send_keys('0'))
        self.wait(lambda s: s['camera'] == -1)

    def test_overlays_are_drawn_by_either_painter(self):
        self.browser.set_window_size(520, 340)
        self.open(more='&painter=gpu')
        self.stand()
        bare = self.pixels()[0]
        self.keys(lambda k: k.send_keys(Keys.F3))
        outlines = self.wait_for_other_pixels(bare)
        overlay = self.browser.find_element('id', 'overlay')
        self.assertEqual(overlay.get_attribute('value'), 'ages')
        self.assertIn('framelets that are held', self.browser.find_element('id', 'legend').text)
        names = [option.text for option in overlay.find_elements('tag name', 'option')]
        self.assertEqual(names, ['none', 'ages', 'confidence', 'refresh-rate', 'arrivals', 'holes'])
        last = outlines
        for name in ('confidence', 'arrivals', 'refresh-rate'):  # of holes there are none at rest
            self.draw_over(name)
            last = self.wait_for_other_pixels(last)
            self.assertNotEqual(last, bare)
        grey = self.wait_for(lambda: self.pixels()[0], lambda p: p[0::3] == p[1::3] == p[2::3])  # once rates have faded
        self.assertGreater(len(set(grey)), 20)
        self.draw_over('holes')
        self.wait_for(lambda: self.pixels()[0], lambda pixels: pixels == bare)
        self.draw_over('ages')
        self.tell('painter', 'cpu')
        self.wait(lambda s: s['painter'] == 'processor')
        self.wait_for(lambda: self.pixels()[0], lambda pixels: pixels == outlines)
        self.draw_over('none')
        self.wait_for(lambda: self.pixels()[0], lambda pixels: pixels == bare)
        self.assertFalse(self.browser.find_element('id', 'legend').is_displayed())

    def test_smooth_motion_is_late_and_what_stands_is_the_same(self):
        self.open()
        self.stand()
        before = self.pixels()[0]
        self.click('smooth')
        self.finish(lambda s: s['lag'] == 0.1)
        self.wait_for(lambda: self.pixels()[0], lambda pixels: pixels == before)
        self.click('play')
        moving = self.wait(lambda s: s['playing'])
        self.wait(lambda s: s['time'] > moving['time'] and s['pictures'] > moving['pictures'] + 3 and s['lag'] == 0.1)
        self.click('smooth')
        self.wait(lambda s: s['lag'] == 0)

    def kept(self, more=''):
        """The bookmarks that the browser keeps, as text; None: there are none."""
        return self.browser.execute_script(
            'const s = window.framelet.state; return localStorage.getItem('
            '`framelet/cameras/${s.scene}-${s.scene_source}${arguments[0]}`)', more)

    def test_bookmarks_are_kept_by_the_browser(self):
        self.open()
        self.wait(lambda s: s.get('pictures', 0) > 0)
        self.tell('orbit', 60, 15)
        self.wait(lambda s: s['camera'] == -1)
        marked = self.view()
        self.keys(lambda k: k.send_keys('b'))
        self.wait_for(self.note, lambda said: said == 'bookmark view 1 added: Shift+1 comes back here')
        self.wait(lambda s: s['bookmarks'] == ['view 1'] and s['bookmark'] == 0)
        self.tell('orbit', -90, 5)
        self.wait(lambda s: s['bookmark'] == -1)
        self.click('bookmark')
        self.wait(lambda s: s['bookmarks'] == ['view 1', 'view 2'])
        self.keys(lambda k: k.key_down(Keys.SHIFT).send_keys('1').key_up(Keys.SHIFT))
        self.wait(lambda s: s['bookmark'] == 0)
        self.assertEqual(self.view()['position'], marked['position'])
        self.leave()
        self.open()
        self.wait(lambda s: s.get('bookmarks') == ['view 1', 'view 2'] and s['camera'] == 0)
        self.browser.execute_script('const c = document.getElementById("camera"); c.value = "bookmark 0";'
                                    'c.dispatchEvent(new Event("change"))')
        self.wait(lambda s: s['bookmark'] == 0)
        self.assertLess(math.dist(self.view()['position'], marked['position']), 1e-4)
        self.click('remove')
        self.wait(lambda s: s['bookmarks'] == ['view 2'])
        self.keys(lambda k: k.key_down(Keys.SHIFT).send_keys('b').key_up(Keys.SHIFT))
        self.wait_for(self.note, lambda said: 'no bookmark has been gone to' in said)
        self.wait_for(self.kept, lambda text: [c['name'] for c in json.loads(text)['cameras']] == ['view 2'])

    def test_broken_bookmarks_are_left_out_and_kept_beside(self):
        self.open()
        self.wait(lambda s: s.get('pictures', 0) > 0)
        hostile = ['{"cameras": 3}', '[' * 300000, '{"cameras": [' + '[' * 300000 + ']' * 300000 + ']}', 'x' * 2000000,
                   '{"cameras": [{"name": "<img src=x onerror=alert(1)>", "position": [0, 0, 1e400]}]}', '\u0000', '']
        keep = ('const s = window.framelet.state; const key = `framelet/cameras/${s.scene}-${s.scene_source}`;'
                'localStorage.setItem(key, arguments[0]); document.getElementById("note").textContent = "";'
                'window.dispatchEvent(new StorageEvent("storage", {key}))')
        for text in hostile:
            self.browser.execute_script(keep, text)
            self.wait_for(self.note, lambda said: said.endswith('bookmarks are left out'))
        good = {'name': '<b>a view</b>', 'position': [0, 1, 5], 'target': [0, 1, 0]}
        self.browser.execute_script(keep, json.dumps({'cameras': [good]}))
        self.wait(lambda s: s['bookmarks'] == [good['name']])
        self.browser.execute_script(keep, hostile[0])
        self.wait(lambda s: s['bookmarks'] == [])
        self.leave()
        self.open()
        self.wait_for(self.note, lambda said: said.endswith('bookmarks are left out'))
        self.click('bookmark')
        self.wait_for(self.kept, lambda text: 'view 1' in text)
        self.assertEqual(self.kept('.broken'), hostile[0])

    def test_plots_show_the_last_seconds(self):
        self.open()
        if not self.wait(lambda s: s.get('pictures', 0) > 0)['playing']:
            self.click('play')
        plots = self.browser.find_element('id', 'plots')
        self.assertFalse(plots.is_displayed())
        self.keys(lambda k: k.send_keys(Keys.F2))
        said = self.wait_for(lambda: plots.get_attribute('aria-label') or '', lambda text: re.fullmatch(
            r'[1-9]\d* pictures/s, [1-9]\d* ms a picture, [1-9]\d* kB/s', text))
        painted = ('const p = document.getElementById("plots");'
                   'const d = p.getContext("2d").getImageData(0, 0, p.width, p.height).data;'
                   'return d.filter((a, i) => i % 4 === 3 && a > 0).length')
        self.assertGreater(self.browser.execute_script(painted), 200, said)
        self.assertTrue(plots.is_displayed())
        self.click('figures')
        self.assertFalse(plots.is_displayed())

    def test_all_controls_are_at_hand_on_a_small_screen(self):
        self.emulate(390, 844, 2)
        self.open()
        self.wait(lambda s: s.get('pictures', 0) > 0)
        self.tap('figures')
        self.draw_over('confidence')
        self.tap('bookmark')
        self.wait(lambda s: s['bookmarks'] == ['view 1'])
        outside = self.browser.execute_script(
            'return [...document.querySelectorAll("#controls *, #legend, #plots, #note")].filter(e => {'
            'const {left, right, bottom} = e.getBoundingClientRect();'
            'return left < 0 || right > innerWidth || bottom > innerHeight; }).map(e => e.id || e.tagName)')
        self.assertEqual(outside, [])
        self.assertGreater(self.browser.execute_script('return document.getElementById("view").clientHeight'), 500)

    def test_what_is_saved_is_what_is_seen(self):
        self.open()
        self.stand()
        saved = self.pixels()
        self.wait_for(self.pixels_on_screen, lambda seen: seen == saved)

    def test_who_loads_the_page_again_still_has_the_clock(self):
        self.is_unusual = True  # the server: it may keep the clock for the page that is left
        self.open()
        self.wait(lambda s: s.get('controls'))
        self.browser.get('about:blank')
        self.open()
        self.wait(lambda s: s.get('controls'))

    def test_a_hidden_page_is_sent_nothing(self):
        self.open()
        if not self.wait(lambda s: s.get('pictures', 0) > 0)['playing']:
            self.click('play')
        hide = ('Object.defineProperty(document, "hidden", {value: arguments[0], configurable: true});'
                'document.dispatchEvent(new Event("visibilitychange"))')
        self.browser.execute_script(hide, True)
        self.rest('samples', seconds=1)
        before = self.state()['samples']
        self.browser.execute_script(hide, False)
        self.wait(lambda s: s['samples'] > before)

    def test_a_page_around_it_drives_it(self):
        self.is_unusual = True  # the server: nobody sees to it that the page in the other leaves in time
        around = http.server.HTTPServer(('127.0.0.1', 0), Around)
        threading.Thread(target=around.serve_forever, daemon=True).start()
        self.addCleanup(around.server_close)
        self.addCleanup(around.shutdown)
        self.browser.get(f'http://localhost:{around.server_port}/#{self.port}')
        ask = ('const done = arguments[arguments.length - 1]; window.onmessage = e => done(e.data);'
               'document.querySelector("iframe").contentWindow.postMessage(arguments[0], "*")')

        def state_of(what):
            self.wait_for(lambda: self.browser.execute_async_script(ask, ['state'])[1], what)
        state_of(lambda s: s.get('pictures', 0) > 0)
        self.browser.execute_async_script(ask, ['play', False])
        state_of(lambda s: not s['playing'])
        self.browser.execute_async_script(ask, ['seek', 0.75])
        state_of(lambda s: s['time'] == 0.75)
        view = json.loads(self.browser.execute_async_script(ask, ['view'])[1])
        view['scene_time'] = 1.5
        self.assertEqual(self.browser.execute_async_script(ask, ['go', json.dumps(view)]), ['go', ''])
        state_of(lambda s: s['time'] == 1.5)
        self.browser.switch_to.frame(self.browser.find_element('tag name', 'iframe'))
        self.assertFalse(self.browser.find_element('id', 'controls').is_displayed())
        self.browser.switch_to.default_content()

    def test_exposure_makes_it_brighter(self):
        self.open()
        self.wait(lambda s: s.get('quality', 'coarse') != 'coarse' or s.get('pictures', 0) > 20)
        before = sum(self.pixels()[0])
        self.browser.execute_script('const e = document.getElementById("exposure"); e.value = 2;'
                                    'e.dispatchEvent(new Event("input"))')
        self.wait_for(lambda: sum(self.pixels()[0]), lambda light: light > 1.2 * before)

    def test_one_finger_orbits_and_two_go_nearer_on_a_small_screen(self):
        self.emulate(390, 450, 1.5)
        self.open()
        self.stand()
        before, width, _ = self.pixels()
        self.assertEqual(width, 585)  # device pixels
        self.touch([(200, 90)], [(230, 90)], [(260, 90)])
        self.wait(lambda s: s['camera'] == -1)
        self.wait_for_other_pixels(before)
        far = self.view()
        self.touch([(150, 90), (250, 90)], [(130, 90), (270, 90)], [(100, 90), (300, 90)])
        nearer = self.wait_for_view(lambda v: self.way_ahead(far, v) > 1)
        self.tell('dolly', -5)  # as the wheel
        self.wait_for_view(lambda v: self.way_ahead(nearer, v) < -1)
        self.assertLessEqual(self.browser.execute_script(
            'return document.getElementById("statistics").getBoundingClientRect().right'), 390)

    def test_finds_a_server_again_that_was_killed(self):
        self.open()
        before = self.wait(lambda s: s.get('pictures', 0) > 0)
        self.end_server()
        self.wait(lambda s: s['reason'])
        self.assertIn('trying to connect again', self.notice())
        self.start_server(port=self.port)
        after = self.wait(lambda s: not s['reason'] and s['reconnections'] > before['reconnections'])
        self.wait(lambda s: s['samples'] > after['samples'])

    def test_a_wrong_token_is_refused_for_good(self):
        self.open('another')
        self.assertTrue(self.wait(lambda s: s.get('reason'))['refused'])
        self.assertIn('token', self.notice())
        self.assertIn('terminal', self.notice())
        self.assertNotIn('again', self.notice())

    def test_says_that_it_is_not_let_in(self):
        self.browser.get(f'http://127.0.0.1:{make_renaming_proxy(self.port)}/#token={token}')
        self.wait_for(self.notice, lambda said: 'does not let this page in' in said and '--web-origin' in said)

    def test_who_asks_for_files_is_no_viewer(self):
        file = folder / 'server.log'
        with file.open('w') as log:
            self.start_server(log=log)
        self.open()
        self.wait(lambda s: s.get('pictures', 0) > 0)
        self.leave()
        said = self.wait_for(file.read_text, lambda text: 'viewer 1 left' in text)
        self.assertIn('viewer 1 connects', said)
        self.assertNotIn('before it was a viewer', said)

    @unittest.skipUnless(shutil.which('openssl'), 'openssl is missing')
    def test_comes_over_tls(self):
        certificate, key = folder / 'cert.pem', folder / 'key.pem'
        subprocess.run(['openssl', 'req', '-x509', '-newkey', 'ec', '-pkeyopt', 'ec_paramgen_curve:prime256v1',
                        '-nodes', '-days', '2', '-subj', '/CN=localhost', '-keyout', key, '-out', certificate],
                       check=True, stderr=subprocess.DEVNULL)
        key.chmod(0o600)
        self.start_server('--tls-cert', certificate, '--tls-key', key)
        self.browser.get(f'https://localhost:{self.port}/#token={token}')
        self.wait(lambda s: s.get('pictures', 0) > 0)

    def test_no_token_goes_to_another_machine_in_clear(self):
        addresses = subprocess.run(['hostname', '-I'], capture_output=True, text=True).stdout.split()
        if not addresses:
            self.skipTest('this machine has no address')
        self.start_server('--bind', '0.0.0.0', '--insecure')
        self.browser.get(f'http://{addresses[0]}:{self.port}/#token={token}')
        self.wait_for(self.notice, lambda said: 'in clear' in said)
        self.assertEqual(self.state(), {})


if __name__ == '__main__':
    run_cases()
