"""The pages of `asphalt-nscd serve`: for one user on this machine, behind a token in the address."""

from __future__ import annotations

import re
import secrets
import shutil
import tempfile
from dataclasses import asdict
from pathlib import Path
from typing import Any

from flask import (
    Flask,
    Response,
    abort,
    jsonify,
    redirect,
    render_template,
    request,
    send_from_directory,
    url_for,
)
from werkzeug.exceptions import HTTPException

from asphalt_nscd.api.laws import TITLES
from asphalt_nscd.files.options import options_of
from asphalt_nscd.measurements.further_kinds import ALL_KINDS
from asphalt_nscd.reporting.settings import Heading
from asphalt_nscd.table_import.campaign import TABLES
from asphalt_nscd.table_import.quantities import MEASURED
from asphalt_nscd.table_import.understand import WORDS_OF
from asphalt_nscd.web.work import SECONDS_TO_DIAGNOSE, SECONDS_TO_READ, Choices, Job

MOST_BYTES = 40_000_000  # of all files of one drop
MOST_FILES = 100
MOST_DESKS = 20
# First in the menus of columns.
USUAL = (
    "E_MPa", "E_GPa", "E_ksi", "phase_deg", "phase_rad", "temperature_C", "temperature_F", "frequency_Hz", "specimen",
    "mix",
)  # fmt: skip
# What a page may load: nothing from elsewhere.
# Inline, because each of our pages is one file with its own style and script.
POLICY = (
    "default-src 'none'; script-src 'self' 'unsafe-inline'; style-src 'self' 'unsafe-inline'; img-src 'self' data:; "
    "connect-src 'self'; frame-src 'self'; form-action 'none'; base-uri 'none'"
)


class Desk:
    """What one tab of the browser works on: its files, and the one piece of work that may be under way."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        # As mkdtemp makes it: other users of the machine cannot look in.
        self.folder.mkdir(mode=0o700)
        self.files: list[Path] = []
        self.choices = Choices()
        self.reading: dict[str, Any] | None = None  # what the page was told of the files
        self.job: Job | None = None

    @property
    def output(self) -> Path:
        """Folder of the results."""
        return self.folder / "results"

    def busy(self) -> bool:
        """Whether a job runs."""
        return self.job is not None and self.job.look() == "running"

    def begin(self, task: str, paths: list[Path], seconds: float) -> Response:
        """Start a job that writes into the folder of results."""
        self.output.mkdir(exist_ok=True)
        self.job = Job(task, paths, self.choices, self.output, seconds)
        return jsonify(state="running")

    def close(self) -> None:
        """Stop the job and remove the folder."""
        if self.job is not None:
            self.job.stop()
        shutil.rmtree(self.folder, ignore_errors=True)


class Desks:
    """The desks of all tabs by their names, in one folder."""

    def __init__(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="asphalt-nscd-"))
        self.desks: dict[str, Desk] = {}

    def desk(self, name: str, anew: bool = False) -> Desk:
        """The desk of a name, an empty one if it is new or wanted `anew`; of too many the oldest idle one goes."""
        if anew and name in self.desks:
            self.desks.pop(name).close()
        if name not in self.desks:
            idle = [other for other, desk in self.desks.items() if not desk.busy()]
            if len(self.desks) >= MOST_DESKS and idle:
                self.desks.pop(idle[0]).close()
            self.desks[name] = Desk(self.folder / name)
        return self.desks[name]

    def close(self) -> None:
        """Stop all jobs and remove all files."""
        for desk in self.desks.values():
            desk.close()
        shutil.rmtree(self.folder, ignore_errors=True)


def create_app(token: str | None = None) -> Flask:
    """The application; `app.config["TOKEN"]` stands in every address."""
    app = Flask(__name__, static_folder=None)
    token = secrets.token_urlsafe(24) if token is None else token
    desks = Desks()
    app.jinja_env.policies["json.dumps_kwargs"] = {"sort_keys": False}  # the menus have an order of their own
    app.config.update(TOKEN=token, DESKS=desks, MAX_CONTENT_LENGTH=MOST_BYTES, MAX_FORM_PARTS=MOST_FILES + 10)

    @app.before_request
    def refuse_strangers() -> None:
        """Refuse other machines, other pages in the browser, and whoever lacks the token."""
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
        """Tell the browser to load nothing from elsewhere, and to keep nothing."""
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
        """A refusal as the page reads it, with what to do where too much was dropped."""
        said = str(error.description)
        # Too many parts of a form have the same code as too many bytes.
        if error.code == 413 and (request.content_length or 0) <= app.config["MAX_CONTENT_LENGTH"]:
            said = f"more than {MOST_FILES} files; give those of one campaign"
        elif error.code == 413:
            said = f"more than {MOST_BYTES // 10**6} MB; give the tables of results alone"
        return jsonify(error=f"{said}."), error.code or 500

    @app.get("/<token>/")
    def new_desk(token: str) -> Any:
        """Each tab has a desk of its own, whose address a reload keeps."""
        return redirect(url_for("page", token=token, desk=secrets.token_hex(6)))

    @app.get("/<token>/<desk>/")
    def page(token: str, desk: str) -> str:
        _named(desk)
        words = {name: WORDS_OF.get(name, name.rpartition("_")[0] or name) for name in MEASURED}
        units = {name: list(MEASURED[name][1]) for name in MEASURED}
        heading = {name: one.help for name, one in options_of(Heading).items()}
        return render_template(
            "page.html",
            units=units,
            words=words,
            usual=USUAL,
            laws=TITLES,
            kinds=ALL_KINDS,
            endings=", ".join(TABLES),
            heading=heading,
        )

    @app.get("/<token>/<desk>/state")
    def state(token: str, desk: str) -> Response:
        """What a page that was loaded again shows."""
        tab = desks.desk(_named(desk))
        job = None if tab.job is None else _told(tab.job)
        return jsonify(reading=tab.reading, choices=asdict(tab.choices), job=job)

    @app.post("/<token>/<desk>/files")
    def drop(token: str, desk: str) -> Response:
        """Take the files, and say how they were read."""
        _idle(desks.desk(_named(desk)))
        given = _given()
        tab = desks.desk(desk, anew=True)
        tab.files = _saved(given, tab.folder / "files")
        return _read(tab)

    @app.post("/<token>/<desk>/read")
    def again(token: str, desk: str) -> Response:
        """Read the files again with what the user chose from the menus."""
        tab = _idle(desks.desk(_named(desk)), files=True)
        tab.choices = _choices(request.get_json(silent=True))
        return _read(tab)

    @app.post("/<token>/<desk>/diagnose")
    def start(token: str, desk: str) -> Response:
        tab = _idle(desks.desk(_named(desk)), files=True)
        tab.choices = _choices(request.get_json(silent=True))
        # An older result would stand beside the new one, or for it after a failure.
        shutil.rmtree(tab.output, ignore_errors=True)
        return tab.begin("diagnose", tab.files, SECONDS_TO_DIAGNOSE)

    @app.post("/<token>/<desk>/compare")
    def compare(token: str, desk: str) -> Response:
        """Diagnose the files of another mix too, and set both beside each other."""
        tab = _idle(desks.desk(_named(desk)), files=True)
        shutil.rmtree(tab.folder / "other", ignore_errors=True)
        other = _saved(_given(), tab.folder / "other")
        return tab.begin("compare", [*tab.files, *other], 2.0 * SECONDS_TO_DIAGNOSE)

    @app.get("/<token>/<desk>/job")
    def job(token: str, desk: str) -> Response:
        tab = desks.desk(_named(desk))
        if tab.job is None:
            abort(404, "nothing was started")
        return jsonify(**_told(tab.job))

    @app.post("/<token>/<desk>/cancel")
    def cancel(token: str, desk: str) -> Response:
        tab = desks.desk(_named(desk))
        if tab.job is not None:
            tab.job.stop()
        return jsonify(state="cancelled")

    @app.get("/<token>/<desk>/results/<path:name>")
    def result(token: str, desk: str, name: str) -> Response:
        tab = desks.desk(_named(desk))
        # Only names that the job has listed, so that no name leads out of the folder.
        if tab.job is None or tab.job.state != "done" or name not in tab.job.result["files"]:
            abort(404, "no such file")
        # One address for both: shown in the page's frame, or taken away.
        return send_from_directory(tab.output, name, as_attachment="download" in request.args)

    return app


def _named(desk: str) -> str:
    """The name of a desk as the page makes it: no path of a folder."""
    if not re.fullmatch(r"[0-9a-f]{12}", desk):
        abort(404, "no such desk; take the address that the terminal shows")
    return desk


def _idle(desk: Desk, files: bool = False) -> Desk:
    """The desk, if no job runs at it, and if it has files where these are asked for."""
    if files and not desk.files:
        abort(409, "drop files first")
    if desk.busy():
        abort(409, "a diagnosis is under way; wait for it or cancel it")
    return desk


def _given() -> list[Any]:
    """The files that the page sends; refuses none, too many, other endings and two of one name."""
    given = [one for one in request.files.getlist("files") if one.filename]
    if not given or len(given) > MOST_FILES:
        abort(400, f"give between one and {MOST_FILES} files")
    names = [safe_name(one.filename or "") for one in given]
    for name in names:
        if Path(name).suffix.lower() not in TABLES:
            abort(400, f"{name}: give files that end in {', '.join(TABLES)}")
        if names.count(name) > 1:
            abort(400, f"{name}: two files have this name")
    return given


def _saved(given: list[Any], folder: Path) -> list[Path]:
    folder.mkdir()
    paths = [folder / safe_name(one.filename or "") for one in given]
    for one, path in zip(given, paths, strict=True):
        one.save(path)
    return paths


def _read(desk: Desk) -> Response:
    job = Job("read", desk.files, desk.choices, None, SECONDS_TO_READ)
    job.finish()
    desk.reading = {"state": job.state, "files": [path.name for path in desk.files], **job.result}
    return jsonify(**desk.reading)


def _told(job: Job) -> dict[str, Any]:
    return {"state": job.look(), "stage": job.stage, "share": job.share, **job.result}


def _choices(content: Any) -> Choices:
    """The choices in what the page sends; refuses what its menus do not hold."""
    if not isinstance(content, dict):
        return Choices()
    kind, law = content.get("measured_in") or None, content.get("law") or "2s2p1d"
    columns, heading = (content.get(name) or {} for name in ("columns", "heading"))
    if not isinstance(columns, dict) or not isinstance(heading, dict):
        abort(400, "an unknown choice")
    if kind not in (None, *ALL_KINDS) or law not in TITLES or not set(heading) <= set(options_of(Heading)):
        abort(400, "an unknown choice")
    texts = [text for pairs in (columns, heading) for pair in pairs.items() for text in pair]
    if not all(isinstance(text, str) and len(text) < 200 for text in texts):
        abort(400, "an unknown choice")
    return Choices(kind, columns, law, heading)


def safe_name(name: str) -> str:
    """The last part of a file's name, with letters, digits and harmless marks alone."""
    last = re.split(r"[\\/]", name)[-1]
    # The end of it, which has the ending that tells the format.
    last = re.sub(r"[^\w .()+-]", "_", last).lstrip(". ")[-120:]
    return last or "file"
