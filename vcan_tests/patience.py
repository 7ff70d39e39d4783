"""How long tests wait for what must come: long, and not by the clock. Nothing is measured by it."""
import time

# For computers that are busy with something else.
PATIENCE_S = 200
# What a pause counts for at most, however long it was: a computer that stands still uses up no patience.
MOST_S = 0.5


class Patience:
    def __init__(self, seconds=PATIENCE_S):
        self.left = seconds

    def wait(self, pause_s):
        """False: it is used up."""
        began = time.monotonic()
        time.sleep(pause_s)
        self.left -= min(time.monotonic() - began, MOST_S)
        return self.left > 0


def until(what, done, seconds=PATIENCE_S, look_s=0.1):
    """What `done` returns, when that is something."""
    patience = Patience(seconds)
    while not (found := done()):
        if not patience.wait(look_s):
            raise AssertionError(f"not within {seconds} s: {what}")
    return found
