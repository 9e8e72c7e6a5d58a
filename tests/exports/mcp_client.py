"""A client of the Python SDK of the Model Context Protocol talks to `hyde mcp`: `mcp_client.py HYDE FOLDER`."""

import asyncio
import json
import sys
from pathlib import Path

import anyio
from mcp import ClientSession, StdioServerParameters
from mcp.client.stdio import stdio_client

hyde, folder = sys.argv[1:]
LONG = "tests/models/ten_minutes.hyde"


def running(word):
    """Whether a process with a word among its arguments runs."""
    for known in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            if word.encode() in known.read_bytes():
                return True
        except OSError:
            pass
    return False


def answer(result):
    assert len(result.content) == 1
    return json.loads(result.content[0].text)


async def main():
    parameters = StdioServerParameters(command=hyde, args=["mcp"])
    async with stdio_client(parameters) as (read, write):
        async with ClientSession(read, write) as session:
            started = await session.initialize()
            assert started.server_info.name == "hyde"
            tools = {tool.name for tool in (await session.list_tools()).tools}
            assert {"check", "run", "modes", "bode", "fit", "diagnose", "look", "explain", "components"} <= tools

            first = {"file": "examples/first/first.hyde", "experiment": "push"}
            checked = answer(await session.call_tool("check", {"file": first["file"]}))
            assert checked["ok"] and checked["exit_status"] == 0

            run = await session.call_tool("run", first | {"out": folder})
            told = answer(run)
            assert told["expectations"][0]["holds"] and told["folder"] == folder, told
            assert len(run.content[0].text) < 20_000

            modes = await session.call_tool("modes", first)
            told = answer(modes)
            assert told["stable"] and told["modes"][0]["frequency_hz"] > 0
            assert len(modes.content[0].text) < 30_000
            whole = json.load(open(told["complete_answer"]))
            assert len(whole["modes"]) >= len(told["modes"])

            response = {"file": "examples/frequency_response/axis.hyde", "experiment": "opened"}
            bode = answer(await session.call_tool("bode", response))
            assert bode["responses"][0]["frequency_hz"]["numbers"] == 400, bode["responses"][0].keys()

            look = answer(await session.call_tool("look", {"files": ["examples/new_axis/strokes.csv"]}))
            assert look["files"][0]["channels"]

            page = await session.call_tool("explain", {"code": "E0503"})
            assert page.content[0].text.startswith("E0503: ")
            wrong = await session.call_tool("check", {"file": "tests/fixtures/errors/E0501_two_supplies.hyde"})
            assert wrong.is_error and answer(wrong)["diagnostics"], wrong
            missing = await session.call_tool("run", {"file": "absent.hyde"})
            assert missing.is_error and "absent.hyde" in missing.content[0].text

            # A run of minutes that the client cancels ends: tools run one after the other, and the next one is answered.
            with anyio.move_on_after(1.0) as scope:
                await session.call_tool("run", {"file": LONG, "out": folder})
            assert scope.cancelled_caught, "it was to be cancelled"
            await session.send_ping()
            checked = answer(await session.call_tool("check", {"file": first["file"]}))
            assert checked["ok"]
            assert not running(LONG), "the run goes on"


asyncio.run(main())
print("done")
