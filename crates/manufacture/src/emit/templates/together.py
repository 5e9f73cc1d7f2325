import sys

sys.path[0] = sys.argv[1]
import contextlib
import io
import json
import os
import traceback
import types


def compiled(name):
    path = os.path.join(sys.argv[1], name + ".py")
    with open(path, "rb") as file:
        return compile(file.read(), path, "exec")


name = sys.argv[2]
library, answer = compiled(name), compiled(name + "_answer")
for line in sys.stdin:
    question = json.loads(line)
    os.environ["MANUFACTURE_VARIANT"] = question["variant"]
    sys.argv = [name + "_answer.py"] + question["arguments"]
    sys.stdin, printed = io.StringIO(question["text"]), io.StringIO()
    text = None
    try:
        with contextlib.redirect_stdout(printed):
            module = sys.modules[name] = types.ModuleType(name)
            exec(library, vars(module))
            exec(answer, {"__name__": "__main__"})
        text = printed.getvalue()
    except BaseException:  # A variant that fails, fails with no other.
        traceback.print_exc()
    print(json.dumps(text), flush=True)
