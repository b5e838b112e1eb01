"""Files and messages of the programs of this package."""
import os
import sys


def write_whole(file, content):
    """Writes text or bytes to a file that appears under its name only when it is whole; `-` is
    the terminal."""
    if isinstance(content, str):
        content = content.encode()
    if str(file) == "-":
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
        return
    part = f"{file}.part{os.getpid()}"
    try:
        with open(part, "wb") as out:
            out.write(content)
            out.flush()
            os.fsync(out.fileno())
        os.replace(part, file)
    except OSError as error:
        if os.path.exists(part):
            os.remove(part)
        raise OSError(error.errno, error.strerror, str(file)) from error


def run_program(name, main):
    """Runs main(). Exit code 0 when done, 1 for bad input, with one sentence that says why."""
    try:
        main()
    except BrokenPipeError:
        return 1
    except OSError as error:
        where = f"{error.filename}: " if error.filename else ""
        print(f"{name}: {where}{error.strerror or error}", file=sys.stderr)
        return 1
    except (ImportError, IndexError, ValueError) as error:
        print(f"{name}: {error}", file=sys.stderr)
        return 1
    return 0
