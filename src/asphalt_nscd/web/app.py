"""The pages of `asphalt-nscd serve`: for one user on this machine, behind a token in the address."""

from __future__ import annotations

import re
import secrets
import shutil
import tempfile
from pathlib import Path
from typing import Any

from flask import Flask, Response, abort, jsonify, render_template, request, send_from_directory
from werkzeug.exceptions import HTTPException

from asphalt_nscd.api.laws import TITLES
from asphalt_nscd.measurements.kinds import TEST_TYPES
from asphalt_nscd.table_import.campaign import TABLES
from asphalt_nscd.table_import.quantities import MEASURED
from asphalt_nscd.web.work import SECONDS_TO_DIAGNOSE, SECONDS_TO_READ, Choices, Job

MOST_BYTES = 40_000_000  # of all files of one drop
MOST_FILES = 100
# What a page may load: nothing from elsewhere.
# Inline, because each of our pages is one file with its own style and script.
POLICY = (
    "default-src 'none'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "connect-src 'self'; frame-src 'self'; form-action 'none'; base-uri 'none'"
)


class Desk:
    """The files of the one user, and the one piece of work that may be under way."""

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="asphalt-nscd-"))
        self.files: list[Path] = []
        self.choices = Choices()
        self.job: Job | None = None

    @property
    def output(self) -> Path:
        """Folder of the results."""
        return self.folder / "results"

    def busy(self) -> bool:
        """Whether a job runs."""
        return self.job is not None and self.job.look() == "running"

    def clear(self) -> None:
        """Forget files and job."""
        shutil.rmtree(self.folder, ignore_errors=True)
        # As mkdtemp made it: other users of the machine cannot look in.
        self.folder.mkdir(mode=0o700)
        self.files, self.job = [], None

    def close(self) -> None:
        """Stop the job and remove the folder."""
        if self.job is not None:
            self.job.stop()
        shutil.rmtree(self.folder, ignore_errors=True)


def create_app(token: str | None = None) -> Flask:
    """The application; `app.config["TOKEN"]` stands in every address."""
    app = Flask(__name__, static_folder=None)
    token = secrets.token_urlsafe(24) if token is None else token
    desk = Desk()
    app.config.update(TOKEN=token, DESK=desk, MAX_CONTENT_LENGTH=MOST_BYTES, MAX_FORM_PARTS=MOST_FILES + 10)

    @app.before_request
    def only_the_user() -> None:
        """No other machine, no other page in the browser, and nobody without the token."""
        # A name of a stranger's may be pointed at 127.0.0.1 (DNS rebinding); the Host header then holds that name.
        host = request.host.rpartition(":")[0] or request.host
        if host not in ("127.0.0.1", "localhost"):
            abort(403, "ask for 127.0.0.1")
        given = (request.view_args or {}).get("token", "")
        # In a time that does not tell how much of the token was right.
        if not secrets.compare_digest(str(given).encode(), token.encode()):
            abort(403, "the address lacks its token; take the address that the terminal shows")
        # Another page in the same browser can post here too, but cannot hide its origin.
        origin = request.headers.get("Origin")
        if request.method != "GET" and origin is not None and origin != f"http://{request.host}":
            abort(403, "another page asked")

    @app.after_request
    def guarded(response: Response) -> Response:
        response.headers.update(
            {
                "Content-Security-Policy": POLICY,
                "X-Content-Type-Options": "nosniff",
                "Referrer-Policy": "no-referrer",
                "Cache-Control": "no-store",
            }
        )
        return response

    @app.errorhandler(HTTPException)
    def error_response(error: HTTPException) -> tuple[Response, int]:
        said = str(error.description)
        # Too many parts of a form have the same code as too many bytes.
        if error.code == 413 and (request.content_length or 0) <= app.config["MAX_CONTENT_LENGTH"]:
            said = f"more than {MOST_FILES} files; give those of one campaign"
        elif error.code == 413:
            said = f"more than {MOST_BYTES // 10**6} MB; give the tables of results alone"
        return jsonify(error=f"{said}."), error.code or 500

    @app.get("/<token>/")
    def page(token: str) -> str:
        units = {name: list(of) for name, (_, of) in MEASURED.items()}
        return render_template(
            "page.html", units=units, laws=TITLES, kinds=TEST_TYPES, endings=", ".join(TABLES)
        )

    @app.post("/<token>/files")
    def drop(token: str) -> Response:
        """Take the files, and say how they were read."""
        if desk.busy():
            abort(409, "a diagnosis is under way; wait for it or cancel it")
        given = [one for one in request.files.getlist("files") if one.filename]
        if not given or len(given) > MOST_FILES:
            abort(400, f"give between one and {MOST_FILES} files")
        desk.clear()
        for one in given:
            path = desk.folder / "files" / safe_name(one.filename or "")
            path.parent.mkdir(exist_ok=True)
            if path.suffix.lower() not in TABLES:
                abort(400, f"{path.name}: give files that end in {', '.join(TABLES)}")
            if path.exists():
                abort(400, f"{path.name}: two files have this name")
            one.save(path)
            desk.files.append(path)
        # They were of the columns of other files.
        desk.choices = Choices()
        return _read(desk)

    @app.post("/<token>/read")
    def again(token: str) -> Response:
        """Read the files again with what the user chose from the menus."""
        if not desk.files or desk.busy():
            abort(409, "drop files first, or wait for the diagnosis")
        desk.choices = _choices(request.get_json(silent=True))
        return _read(desk)

    @app.post("/<token>/diagnose")
    def start(token: str) -> Response:
        if not desk.files:
            abort(409, "drop files first")
        if desk.busy():
            abort(409, "a diagnosis is under way; wait for it or cancel it")
        desk.choices = _choices(request.get_json(silent=True))
        # An older result would stand beside the new one, or for it after a failure.
        shutil.rmtree(desk.output, ignore_errors=True)
        desk.output.mkdir()
        desk.job = Job("diagnose", desk.files, desk.choices, desk.output, SECONDS_TO_DIAGNOSE)
        return jsonify(state="running")

    @app.get("/<token>/job")
    def job(token: str) -> Response:
        if desk.job is None:
            abort(404, "nothing was started")
        state = desk.job.look()
        return jsonify(state=state, stage=desk.job.stage, share=desk.job.share, **desk.job.result)

    @app.post("/<token>/cancel")
    def cancel(token: str) -> Response:
        if desk.job is not None:
            desk.job.stop()
        return jsonify(state="cancelled")

    @app.get("/<token>/results/<name>")
    def result(token: str, name: str) -> Response:
        # Only names that the job has listed, so that no name leads out of the folder.
        if desk.job is None or desk.job.state != "done" or name not in desk.job.result["files"]:
            abort(404, "no such file")
        # One address for both: shown in the page's frame, or taken away.
        return send_from_directory(desk.output, name, as_attachment="download" in request.args)

    return app


def _read(desk: Desk) -> Response:
    job = Job("read", desk.files, desk.choices, None, SECONDS_TO_READ)
    job.finish()
    return jsonify(state=job.state, files=[path.name for path in desk.files], **job.result)


def _choices(content: Any) -> Choices:
    """What came from the menus, no more than these hold."""
    if not isinstance(content, dict):
        return Choices()
    kind, law = content.get("measured_in") or None, content.get("law") or "2s2p1d"
    columns = content.get("columns") or {}
    if kind not in (None, *TEST_TYPES) or law not in TITLES or not isinstance(columns, dict):
        abort(400, "an unknown choice")
    if not all(isinstance(text, str) and len(text) < 200 for pair in columns.items() for text in pair):
        abort(400, "an unknown choice")
    return Choices(kind, columns, law)


def safe_name(name: str) -> str:
    """The last part of a file's name, with letters, digits and harmless marks alone."""
    last = re.split(r"[\\/]", name)[-1]
    # The end of it, which has the ending that tells the format.
    last = re.sub(r"[^\w .()+-]", "_", last).lstrip(". ")[-120:]
    return last or "file"
