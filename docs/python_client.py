#!/usr/bin/python3
"""The smallest client of a framelet-server: one picture of a scene, as PROTOCOL.md says how to get it.

It asks for colour in encoding 1 alone, which every server sends to those who name nothing else, shows framelets where
they were rendered, and ends once the picture is as good as it gets, or after ten seconds where the scene moves.

Wants Debian's python3-flatbuffers, python3-zstandard, python3-numpy and flatbuffers-compiler. A server that was given
no token wrote one into a file for its own user: GUIDE.md says where ("Beyond one machine").
"""
import argparse, pathlib, re, socket, struct, subprocess, sys, tempfile, time
import flatbuffers, numpy, zstandard

schema = pathlib.Path(__file__).resolve().parent.parent / "protocol/messages/framelet.fbs"
with tempfile.TemporaryDirectory() as generated:
    subprocess.run(["flatc", "--python", "--gen-object-api", "-o", generated, schema], check=True)
    sys.path.insert(0, generated)
    from framelet.wire import Ack, Body, CameraUpdate, Hello, Message, View, Viewport, ViewerSettings

def send(connection, body_type, body):
    message, builder = Message.MessageT(), flatbuffers.Builder(1024)
    message.bodyType, message.body = body_type, body
    builder.Finish(message.Pack(builder), b"FRML")
    connection.sendall(struct.pack("<I", len(builder.Output())) + builder.Output())

def receive(stream):
    length = stream.read(4)
    if len(length) < 4:
        sys.exit("python_client.py: the server has closed the connection")
    body = stream.read(struct.unpack("<I", length)[0])
    message = Message.MessageT.InitFromObj(Message.Message.GetRootAs(body))
    if message.bodyType == Body.Body.Failure:
        sys.exit("python_client.py: " + message.body.text.decode())
    return message.body

def filled(table, **fields):
    for name, value in fields.items():
        setattr(table, name, value)
    return table

def tiles_of(data):
    """Codes of tiles: "The list of a batch's tiles"."""
    codes, depth, end, left = [], 0, 0, iter(data)  # `end`: of the tile before, at depth 15
    for byte in left:
        number, bit = byte & 127, 7
        while byte & 128:
            byte = next(left)
            number, bit = number | (byte & 127) << bit, bit + 7
        depth = next(left) if number & 1 else depth
        index = (end >> 2 * (15 - depth)) + (number >> 2) * (-1 if number & 2 else 1)
        end = index + 1 << 2 * (15 - depth)
        codes.append((1 << 2 * depth) + index)
    return codes

def decode(data, count):
    """Samples of `count` framelets, each 16 x 16 x 3 bytes: "Samples: encoding 1"."""
    groups = (count + 127) // 128
    at = 4 * max(groups - 1, 0)
    for length in (*struct.unpack_from(f"<{at // 4}I", data), len(data))[:groups]:  # the last one takes what is left
        planes = numpy.frombuffer(zstandard.decompress(data[at:at + length]), numpy.uint8).reshape(3, -1, 16, 16).copy()
        planes[..., 0] = planes[..., 0].cumsum(-1, numpy.uint8)  # the first column by the rows above, then all rows
        yield from planes.cumsum(-1, numpy.uint8).transpose(1, 2, 3, 0)
        at += length

def paint(framelets, width, height):
    """The picture of (batch, samples) by tile code, later and then finer ones over others, at four points a pixel."""
    points = numpy.zeros((4 * height, 4 * width, 3), numpy.uint8)
    k = next(k for k in range(16) if 16 << k >= max(width, height))
    for code in sorted(framelets, key=lambda code: (framelets[code][0], code)):  # a deeper tile has a greater code
        depth = (code.bit_length() - 1) // 2
        column, row = (sum((code >> 2 * bit + axis & 1) << bit for bit in range(depth)) for axis in (0, 1))
        side = 64 << k >> depth
        tile = points[row * side:(row + 1) * side, column * side:(column + 1) * side]
        samples = framelets[code][1].repeat(side // 16, 0).repeat(side // 16, 1)
        tile[:] = samples[:tile.shape[0], :tile.shape[1]]
    level = numpy.arange(256, dtype=numpy.float32) / 255
    light = numpy.where(level <= 0.04045, level / 12.92, ((level + 0.055) / 1.055) ** 2.4)  # means are of light
    means = light[points].reshape(height, 4, width, 4, 3).mean((1, 3))
    return numpy.interp(means, light, numpy.arange(256)).round().astype(numpy.uint8)

def look(host, port, token, width, height):
    """Numbers of batches and framelets by tile code, once the picture is as good as it gets or ten seconds are over."""
    with socket.create_connection((host, port), 10) as connection, connection.makefile("rb") as stream:
        send(connection, Body.Body.Hello, filled(Hello.HelloT(), version=7, token=token, codings=1))
        welcome = receive(stream)
        viewport = filled(Viewport.ViewportT(), width=width, height=height)
        view = filled(View.ViewT(), number=1, camera=welcome.startCamera, viewport=viewport, heldSince=1)
        send(connection, Body.Body.ViewerSettings, filled(ViewerSettings.ViewerSettingsT(), reproject=False))
        send(connection, Body.Body.CameraUpdate, filled(CameraUpdate.CameraUpdateT(), view=view))
        framelets, newest, last, end = {}, 0, None, time.monotonic() + 10
        while time.monotonic() < end and newest != last:
            message = receive(stream)
            if hasattr(message, "colours"):  # a Batch
                received = time.monotonic_ns() // 1000
                newest, codes = message.number, tiles_of(bytes(message.tiles))
                samples = decode(bytes(message.colours), len(codes))
                framelets.update((code, (newest, one)) for code, one in zip(codes, samples))
                send(connection, Body.Body.Ack, filled(Ack.AckT(), batch=newest, receivedUs=received))
            elif hasattr(message, "converged"):  # a Status, which may come before the Batch that it names
                last = message.lastBatch if message.converged and message.cameraNumber == 1 else None
    return framelets

def main():
    parser = argparse.ArgumentParser(description="Writes one picture of what a framelet-server shows (PPM).")
    parser.add_argument("server", metavar="HOST:PORT")
    parser.add_argument("picture", help="file to write")
    parser.add_argument("--token-file", metavar="FILE", help="that the server was given, or has written")
    parser.add_argument("--size", default="640x360", metavar="WIDTHxHEIGHT")
    arguments = parser.parse_args()
    if not re.fullmatch(r"\S+:\d{1,5}", arguments.server) or not re.fullmatch(r"[1-9]\d{0,3}x[1-9]\d{0,3}", arguments.size):
        parser.error("give the server as HOST:PORT, the size as WIDTHxHEIGHT")
    host, port = arguments.server.rsplit(":", 1)
    width, height = map(int, arguments.size.split("x"))
    try:
        token = pathlib.Path(arguments.token_file).read_text().strip() if arguments.token_file else ""
        picture = paint(look(host, int(port), token, width, height), width, height)
        with open(arguments.picture, "wb") as file:
            file.write(b"P6 %d %d 255\n" % (width, height) + picture.tobytes())
    except (OSError, OverflowError) as error:
        sys.exit(f"python_client.py: {error}")

if __name__ == "__main__":
    main()
