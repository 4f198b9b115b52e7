#!/usr/bin/python3
"""The page in Firefox, of a real server: firefox_test.py SERVER CLIENT PAGE SCENE FOLDER [Page.test_NAME ...].

FOLDER gets the screenshots. Exit code 77 where there is no Firefox here. Debian has no driver for it: it is spoken to
by its own protocol, Marionette, of which this is what the cases need."""
import base64
import contextlib
import json
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import unittest

sys.dont_write_bytecode = True
from page_case import PageCase, most_seconds, run_cases, skip

program = shutil.which('firefox-esr') or shutil.which('firefox') or skip('firefox-esr is missing')


class Firefox:
    def __init__(self):
        self.profile = tempfile.TemporaryDirectory()
        port_file = pathlib.Path(self.profile.name) / 'MarionetteActivePort'
        (pathlib.Path(self.profile.name) / 'user.js').write_text('user_pref("marionette.port", 0);\n')
        self.process = subprocess.Popen([program, '--headless', '--marionette', '--profile', self.profile.name],
                                        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        end = time.monotonic() + most_seconds
        while not port_file.exists() or not port_file.read_text():
            if time.monotonic() > end:
                raise RuntimeError('Firefox does not listen')
            time.sleep(0.1)
        self.socket = socket.create_connection(('127.0.0.1', int(port_file.read_text())), timeout=most_seconds)
        self.stream = self.socket.makefile('rb')
        self.read()  # who it is
        self.call('WebDriver:NewSession', strictFileInteractability=False)
        self.call('WebDriver:SetTimeouts', script=1000 * most_seconds)

    def read(self):
        size = b''.join(iter(lambda: self.stream.read(1), b':'))
        return json.loads(self.stream.read(int(size)))

    def call(self, command, **parameters):
        said = json.dumps([0, 0, command, parameters]).encode()
        self.socket.sendall(b'%d:%s' % (len(said), said))
        _, _, error, answer = self.read()
        if error:
            raise RuntimeError(f'{command}: {error["message"]}')
        return answer.get('value') if isinstance(answer, dict) else answer

    # as selenium's drivers have it

    def get(self, address):
        self.call('WebDriver:Navigate', url=address)

    def execute_script(self, script, *arguments):
        return self.call('WebDriver:ExecuteScript', script=script, args=arguments)

    def execute_async_script(self, script, *arguments):
        return self.call('WebDriver:ExecuteAsyncScript', script=script, args=arguments)

    def find_element(self, by, name):
        element = self.call('WebDriver:FindElement', using='css selector', value='#' + name)
        return Element(self, next(iter(element.values())))

    def set_window_size(self, width, height):
        self.call('WebDriver:SetWindowRect', width=width, height=height)

    def save_screenshot(self, file):
        pathlib.Path(file).write_bytes(base64.b64decode(self.call('WebDriver:TakeScreenshot', full=False)))

    def get_log(self, of):
        return []  # it has none to give

    def quit(self):
        with contextlib.suppress(OSError, RuntimeError, ValueError):
            self.call('Marionette:Quit')
        self.process.kill()
        self.process.wait()
        self.profile.cleanup()


class Element:
    def __init__(self, browser, name):
        self.browser, self.name = browser, name

    def click(self):
        self.browser.call('WebDriver:ElementClick', id=self.name)


class Page(PageCase):
    @classmethod
    def start_browser(cls):
        return Firefox()

    def test_still_picture_is_that_of_framelet_client(self):
        self.still_picture_is_that_of_framelet_client('auto')

    def test_moves_and_orbits(self):
        self.open()
        if not self.wait(lambda s: s.get('pictures', 0) > 0)['playing']:
            self.click('play')
        before = self.wait(lambda s: s['playing'])
        self.wait(lambda s: s['time'] > before['time'] and s['pictures'] > before['pictures'] + 5)
        self.stand()
        still = self.pixels()[0]
        finger = [{'type': 'pointerMove', 'x': 200, 'y': 150}, {'type': 'pointerDown', 'button': 0},
                  {'type': 'pointerMove', 'x': 290, 'y': 170, 'duration': 200}, {'type': 'pointerUp', 'button': 0}]
        self.browser.call('WebDriver:PerformActions', actions=[
            {'type': 'pointer', 'id': 'finger', 'parameters': {'pointerType': 'touch'}, 'actions': finger}])
        self.wait(lambda s: s['camera'] == -1)
        self.wait_for_other_pixels(still)

    def test_finds_a_server_again_that_was_killed(self):
        self.open()
        before = self.wait(lambda s: s.get('pictures', 0) > 0)
        self.start_server(port=self.port)
        self.wait(lambda s: s['reconnections'] > before['reconnections'])
        self.stand()


if __name__ == '__main__':
    run_cases()
