"""Files and messages of the programs of this package."""
import os
import socket
import sys


def write_whole(file, content, inputs=()):
    """Writes text or bytes to a file that appears under its name only when it is whole; `-` is
    the terminal. A symbolic link stays; what is no regular file, such as a pipe, is written to.

    inputs: files that were read. Raises ValueError if `file` is one of them.
    """
    if isinstance(content, str):
        content = content.encode()
    if str(file) == "-":
        sys.stdout.buffer.write(content)
        sys.stdout.buffer.flush()
        return
    target = os.path.realpath(file)
    if os.path.exists(target):
        if any(os.path.exists(i) and os.path.samefile(target, i) for i in inputs):
            raise ValueError(f"{file}: is an input, too")
        if not os.path.isfile(target):
            with open(target, "wb") as out:
                out.write(content)
            return
    # Programs on several machines may share a folder.
    part = f"{target}.part{os.getpid()}-{socket.gethostname()}"
    try:
        with open(part, "wb") as out:
            out.write(content)
            out.flush()
            os.fsync(out.fileno())
        os.replace(part, target)
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
