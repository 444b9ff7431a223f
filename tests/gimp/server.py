"""Script-Fu's server inside a GIMP that runs in a window."""
import socket

import xcf
from window import wait_for

# The image that was opened first, as i.
IMAGE = {"2": "(define i (vector-ref (cadr (gimp-image-list)) 0))",
         "3": "(define i (vector-ref (car (gimp-get-images)) 0))"}


def receive(link, count):
    """Exactly so many bytes: MSG_WAITALL does not wait on a socket with a time limit."""
    data = b""
    while len(data) < count:
        part = link.recv(count - len(data))
        assert part, f"the server hung up after {data!r}"
        data += part
    return data


class Server:
    """Script-Fu's server in the GIMP under test."""

    def __init__(self, host):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        log = host.folder / "server.log"
        self.script = (
            f'(plug-in-script-fu-server RUN-NONINTERACTIVE "127.0.0.1" {self.port} "{log}")'
            if host.name == "2" else
            f'(plug-in-script-fu-server #:run-mode RUN-NONINTERACTIVE #:ip "127.0.0.1"'
            f' #:port {self.port} #:logfile "{log}")')

    def run(self, script):
        def connect():
            return socket.create_connection(("127.0.0.1", self.port), 60)
        with wait_for(connect, 30) as link:
            data = script.encode()
            link.sendall(b"G" + len(data).to_bytes(2, "big") + data)
            head = receive(link, 4)
            text = receive(link, int.from_bytes(head[2:], "big")).decode()
        return head[1] == 0, text

    def save(self, path):
        good, text = self.run(f'(t-save i "{path}")')
        assert good, text
        return xcf.Image(path)
