"""Starts Debian's Chromium for Selenium. Raises ImportError where something for that is missing."""
import shutil

from selenium import webdriver


def start_chromium(width, height):
    """A browser without a window, whose own one is of this size, and whose OpenGL is a program."""
    if not shutil.which('chromium') or not shutil.which('chromedriver'):
        raise ImportError('chromium or chromium-driver is missing')
    options = webdriver.ChromeOptions()
    for option in ('--headless=new', '--no-sandbox', f'--window-size={width},{height}', '--force-device-scale-factor=1',
                   '--disable-dev-shm-usage', '--use-gl=angle', '--use-angle=swiftshader',
                   '--enable-unsafe-swiftshader'):
        options.add_argument(option)
    options.accept_insecure_certs = True
    options.set_capability('goog:loggingPrefs', {'browser': 'ALL'})
    service = webdriver.chrome.service.Service(shutil.which('chromedriver'))
    return webdriver.Chrome(service=service, options=options)
