"""What the tests with Debian's printcore share: a noisy line, and one print by printcore as it is."""
import logging, os, pty, random, select, sys, termios, threading, time, tty

logging.disable(logging.INFO)
from printrun import gcoder
from printrun.printcore import printcore

sys.path.append(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from patience import Patience  # noqa: E402


def until(seconds, what, condition):
    patience = Patience(seconds)
    while not condition():
        if not patience.wait(0.02):
            sys.exit(f"FAILED: no {what} within {seconds} s")


class NoisyLine:
    """A second pty in front of a serial port: a byte of some lines from the host is changed on its way."""

    def __init__(self, port, share, seed):
        self.random, self.share, self.damaged, self.resends = random.Random(seed), share, 0, 0
        self.device = os.open(port, os.O_RDWR | os.O_NOCTTY)
        tty.setraw(self.device)
        self.host, slave = pty.openpty()
        tty.setraw(slave)
        self.slave, self.path = slave, os.ttyname(slave)
        threading.Thread(target=self._relay, daemon=True).start()

    def _relay(self):
        while True:
            ready, _, _ = select.select([self.device, self.host], [], [])
            if self.device in ready:
                data = os.read(self.device, 4096)
                self.resends += data.count(b"Resend:")
                os.write(self.host, data)
            if self.host in ready:
                data = bytearray(os.read(self.host, 4096))
                # M110 tells the gateway the numbers: printcore does not repeat it.
                if data.startswith(b"N") and b"M110" not in data and self.random.random() < self.share:
                    data[self.random.randrange(len(data))] ^= 1 << self.random.randrange(7)
                    self.damaged += 1
                os.write(self.device, bytes(data))


def print_file(port, path, seconds):
    """Prints `path` with printcore and waits until the machine has carried all of it out."""
    core = printcore(port, 115200)
    heard = []
    core.recvcb = heard.append
    until(200, "greeting of the gateway (printcore online)", lambda: core.online)
    with open(path) as file:
        code = gcoder.LightGCode([line.rstrip("\n") for line in file])
    began = time.monotonic()
    assert core.startprint(code), "printcore does not begin"
    until(seconds, "end of the print", lambda: not core.printing)
    oks = sum(line.startswith("ok") for line in heard)
    core.send_now("M400")
    until(seconds, "ok for M400", lambda: sum(line.startswith("ok") for line in heard) > oks)
    took = time.monotonic() - began
    core.disconnect()
    refused = [line for line in heard if line.startswith("Error") and "Last Line" not in line]
    if refused:
        sys.exit("FAILED: refused: " + "".join(refused[:5]))
    return took, heard
