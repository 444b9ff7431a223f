"""Tests that print TAP case by case."""


class Tap:
    def __init__(self):
        self.count = self.failed = 0

    def check(self, good, name, said=''):
        self.count += 1
        self.failed += not good
        print(f'{"ok" if good else "not ok"} {self.count} - {name}', flush=True)
        if said:
            print(f'# {said}', flush=True)

    def skip(self, name, reason):
        self.count += 1
        print(f'ok {self.count} - {name} # SKIP {reason}', flush=True)

    def finish(self):
        print(f'1..{self.count}')
        return 1 if self.failed else 0
