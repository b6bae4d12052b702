from __future__ import annotations

import click

from asphalt_nscd.cli._options import option, step


@step
def command(
    *,
    port: int = option("Port; 0 takes a free one.", 0, low=0, high=65535),
    browser: bool = option("Whether to open the page.", True),
) -> None:
    """Open a page on this machine to drop measurements on; nothing leaves the machine."""
    import signal
    import sys
    import webbrowser

    try:
        from werkzeug.serving import WSGIRequestHandler, make_server

        from asphalt_nscd.web.app import create_app
        from asphalt_nscd.web.janitor import watch
    except ModuleNotFoundError as error:
        # Any other module that is missing is a fault of ours.
        if error.name not in ("flask", "werkzeug"):
            raise
        raise click.ClickException(
            f"this command needs {error.name}; pip install 'asphalt-nscd[web]'."
        ) from None

    class Quiet(WSGIRequestHandler):
        """Each request would print a line; what fails is still told."""

        def log_request(self, code: int | str = "-", size: int | str = "-") -> None:
            pass

    app = create_app()
    # 127.0.0.1: no other machine can reach it.
    server = make_server("127.0.0.1", port, app, threaded=True, request_handler=Quiet)
    address = f"http://127.0.0.1:{server.server_port}/{app.config['TOKEN']}/"
    # Windows has no SIGHUP.
    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), lambda *_: sys.exit(0))
    janitor = watch(app.config["DESKS"].folder)
    click.echo(f"Drop measurements on {address}\nCtrl-C ends it and removes what was dropped.")
    if browser:
        webbrowser.open(address)
    try:
        server.serve_forever()
    finally:
        # However it ended, nothing of a laboratory's stays behind.
        app.config["DESKS"].close()
        janitor.communicate()
