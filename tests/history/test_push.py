"""A copy in another repository, by git and by dulwich: what fails is said, and nothing here is lost."""

from __future__ import annotations

import itertools
import os
import shlex
import socket
import stat
import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from types import SimpleNamespace
from typing import TYPE_CHECKING
from wsgiref.simple_server import WSGIRequestHandler, make_server

import pytest
from dulwich.repo import Repo
from dulwich.server import BackendRepo, DictBackend
from dulwich.web import make_wsgi_chain

from fatektool.errors import PushFailed
from fatektool.history.push import bounded, push
from fatektool.history.push.outcome import failed, without_secrets
from tests.history.books import GIT, ONE, THREE, TWO, Book, git

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

SSH = f"""#!/bin/sh
# ssh HOST COMMAND, where HOST is this computer
for word; do last=$word; done
printf '%s\\n' "$*" >> "$0.said"
PATH={shlex.quote(os.path.dirname(GIT))}:/usr/bin:/bin exec sh -c "$last"
"""  # noqa: PTH120
posix = pytest.mark.skipif(sys.platform == "win32", reason="stands in for programs with shell scripts")


@pytest.fixture(params=["git", "dulwich"])
def by(request: pytest.FixtureRequest, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """Who pushes: with 'dulwich' there is no git program in PATH."""
    if request.param == "dulwich":
        bare = tmp_path / "bin"
        bare.mkdir()
        monkeypatch.setenv("PATH", str(bare))
    return str(request.param)


@pytest.fixture
def nas(book: Book, tmp_path: Path) -> Path:
    assert book.record("press", ONE)
    git(tmp_path, "init", "--quiet", "--bare", "--initial-branch=master", "nas")
    return tmp_path / "nas"


def script(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    path.chmod(stat.S_IRWXU)
    return path


@pytest.mark.usefixtures("by")
@pytest.mark.parametrize("form", ["{0}", "nas", "./nas", "file://{0}", "NAS"])
def test_to_a_folder(book: Book, nas: Path, tmp_path: Path, form: str) -> None:
    book.git("remote", "add", "--mirror=push", "NAS", str(nas))
    remote = form.format(nas)
    first = push(book.folder, remote)
    assert first.sent
    assert not push(book.folder, remote).sent
    book.record("press", TWO, THREE)
    second = push(book.folder, remote)
    assert (second.sent, second.revision) == (True, book.git("rev-parse", "HEAD").strip())
    git(tmp_path, "clone", "--quiet", str(nas), "clone")
    assert (tmp_path / "clone" / "press.json").read_bytes() == THREE.to_bytes()
    git(nas, "fsck", "--strict")


@pytest.mark.usefixtures("by")
def test_where_a_remote_of_the_configuration_is(book: Book, nas: Path, tmp_path: Path) -> None:
    """``pushurl`` goes before ``url``, a relative path is the history's, and %20 is a space."""
    nas.rename(tmp_path / "the nas")
    place = f"file://{tmp_path}/the%20nas"
    for name, url, pushurl in (
        ("PLAIN", "../the nas", None),
        ("NAS", f"{tmp_path}/nowhere", "../the nas"),
        ("URL", "https://192.0.2.1/reads", place),
    ):
        book.git("remote", "add", name, url)
        if pushurl is not None:
            book.git("config", f"remote.{name}.pushurl", pushurl)
        elsewhere = tmp_path / "elsewhere" / name
        elsewhere.mkdir(parents=True)
        os.chdir(elsewhere)
        found = push(book.folder, name)
        assert found.remote == (pushurl or url)
        assert found.sent == (name == "PLAIN")
    assert not push(book.folder, place).sent
    assert git(tmp_path / "the nas", "rev-parse", "main") == book.git("rev-parse", "main")


def test_a_remote_with_two_places(book: Book, nas: Path, tmp_path: Path, by: str) -> None:
    git(tmp_path, "init", "--quiet", "--bare", "other")
    book.git("remote", "add", "BOTH", str(nas))
    for place in (nas, tmp_path / "other"):
        book.git("config", "--add", "remote.BOTH.pushurl", str(place))
    if by == "dulwich":
        with pytest.raises(PushFailed, match="several pushurl: only the git program can push to these"):
            push(book.folder, "BOTH")
        return
    assert push(book.folder, "BOTH").remote == f"{nas}, {tmp_path / 'other'}"
    assert git(tmp_path / "other", "rev-parse", "main") == git(nas, "rev-parse", "main")


@pytest.mark.usefixtures("by")
def test_nothing_yet(nas: Path, tmp_path: Path) -> None:
    git(tmp_path, "init", "--quiet", "--bare", "empty")
    found = push(tmp_path / "empty", str(nas))
    assert (found.revision, found.sent) == (None, False)


@pytest.mark.usefixtures("by")
def test_one_that_has_gone_another_way(book: Book, nas: Path, tmp_path: Path) -> None:
    other = Book(tmp_path / "other")
    other.record("saw", ONE)
    push(other.folder, str(nas))
    before = git(nas, "rev-parse", "main")
    book.git("remote", "add", "--mirror=push", "NAS", str(nas))  # with git a mirror is forced
    for remote in (str(nas), "NAS"):
        with pytest.raises(PushFailed, match=r"has other commits: its refs/heads/main .*nothing was pushed"):
            push(book.folder, remote)
    assert git(nas, "rev-parse", "main") == before
    assert book.record("press", TWO)[0].revision


@pytest.mark.usefixtures("by")
def test_one_that_is_ahead(book: Book, nas: Path, tmp_path: Path) -> None:
    push(book.folder, str(nas))
    git(tmp_path, "clone", "--quiet", "--bare", str(nas), "copy")
    Book(tmp_path / "copy").record("press", TWO)
    push(tmp_path / "copy", str(nas))
    with pytest.raises(PushFailed, match="has other commits"):
        push(book.folder, str(nas))


@pytest.mark.parametrize(
    ("url", "shown"),
    [
        ("https://user:secret@host/x", "https://host/x"),
        ("https://token@host/x", "https://host/x"),
        ("https://host/x@y", "https://host/x@y"),
        ("ssh://git@host/x", "ssh://git@host/x"),
        ("ssh://git:secret@host:22/x", "ssh://git@host:22/x"),
        ("git@host:x", "git@host:x"),
    ],
)
def test_what_is_shown_of_a_remote(url: str, shown: str) -> None:
    """No secret, and what is needed to reach it: without its user an ssh remote is another one."""
    error = failed(url, f"fatal: {url!r} is not there", f"git push {without_secrets(url)}")
    assert error.message == f"could not push to {shown}: fatal: {shown!r} is not there"
    assert str(error.hint).endswith(f"git push {shown}")


@pytest.mark.parametrize(
    ("remote", "by_git", "by_dulwich"),
    [
        (
            "nowhere",
            "the folder does not exist; nothing is lost",
            "the folder does not exist",
        ),
        ("git://127.0.0.1:1/x", "Connection refused", "expected a folder, http://"),
        ("http://user:secret@127.0.0.1:1/x", "unable to access 'http://127.0.0.1:1/x/'", "refused"),
        ("work", "branch is currently checked out", "it has a work tree, expected a bare repository"),
        ("work/.git", "branch is currently checked out", "it has a work tree, expected a bare repository"),
        (".", "does not appear to be a git repository; nothing is lost", "NotGitRepository"),
        ("", "no remote is given; nothing is lost", "no remote is given"),
        ("a:b", "nossh: ", "FileNotFoundError"),
    ],
)
@pytest.mark.usefixtures("nas")
def test_no_place_to_push_to(book: Book, remote: str, by_git: str, by_dulwich: str, by: str) -> None:
    git(book.folder.parent, "init", "--quiet", "--initial-branch=main", "work")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GIT_SSH_COMMAND", "nossh")
        with pytest.raises(PushFailed) as raised:
            push(book.folder, remote, timeout_s=5)
    said = str(raised.value)
    assert said.startswith("could not push to " + (remote.replace("user:secret@", "") or "''") + ": ")
    assert (by_git if by == "git" else by_dulwich) in said
    assert "secret" not in said
    assert raised.value.exit_code == 3
    assert "\n" not in said


@posix
def test_a_hook_that_forbids(book: Book, nas: Path, by: str) -> None:
    hook = script(nas / "hooks" / "pre-receive", "#!/bin/sh\necho closed until Monday >&2\nexit 1\n")
    with pytest.raises(PushFailed) as raised:
        push(book.folder, str(nas))
    if by == "git":
        assert "[remote rejected] (pre-receive hook declined); remote: closed until Monday" in str(
            raised.value
        )
        assert f"for git's own messages run: git -C {book.folder} push {nas} refs/heads/main" in str(
            raised.value
        )
    else:
        assert "it has a hook, pre-receive, which only the git program can run" in str(raised.value)
    git(nas, "rev-parse", "--verify", "--quiet", "main", code=1)
    hook.chmod(0o600)
    assert push(book.folder, str(nas)).sent


@posix
@pytest.mark.parametrize("how", ["PATH", "GIT_SSH_COMMAND", "GIT_SSH", "core.sshCommand"])
def test_by_ssh(book: Book, nas: Path, monkeypatch: pytest.MonkeyPatch, by: str, how: str) -> None:
    tmp_path = nas.parent
    ssh = script(tmp_path / "ssh", SSH)
    if how == "PATH":
        monkeypatch.setenv(
            "PATH", f"{tmp_path}:{os.environ['PATH']}:/usr/bin:/bin" if by == "git" else str(tmp_path)
        )
    elif how == "core.sshCommand":
        book.git("config", how, str(ssh))
    else:
        monkeypatch.setenv(how, str(ssh))
    remotes = ((f"ssh://me@nas.invalid{nas}", TWO), (f"me@nas.invalid:{nas}", THREE))
    for remote, new in remotes if how == "PATH" else remotes[:1]:
        assert push(book.folder, remote).sent
        said = (tmp_path / "ssh.said").read_text(encoding="utf-8").splitlines()[-1]
        assert said.startswith("-o BatchMode=yes -o ConnectTimeout=30 ") == (how == "PATH")
        assert "me@nas.invalid" in said
        assert "git-receive-pack" in said
        book.record("press", new)
    script(nas / "hooks" / "pre-receive", "#!/bin/sh\nexit 1\n")
    with pytest.raises(PushFailed, match="pre-receive hook declined"):
        push(book.folder, f"ssh://nas.invalid{nas}")
    script(ssh, "#!/bin/sh\necho 'Permission denied (publickey).' >&2\nexit 255\n")
    with pytest.raises(PushFailed, match=r"could not push to ssh://nas\.invalid") as raised:
        push(book.folder, f"ssh://nas.invalid{nas}")
    assert "Permission denied (publickey)" in str(raised.value) or by == "dulwich"


class Quiet(WSGIRequestHandler):
    def log_message(self, *_: object) -> None:
        """Say nothing."""


@contextmanager
def web(nas: Path) -> Iterator[str]:
    repository = Repo(str(nas))
    known: dict[str, BackendRepo] = {"/nas": repository}
    application = make_wsgi_chain(DictBackend(known))
    with make_server("127.0.0.1", 0, application, handler_class=Quiet) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        try:
            yield f"http://127.0.0.1:{server.server_port}"
        finally:
            server.shutdown()
            thread.join()
            repository.close()


@pytest.mark.usefixtures("by")
def test_by_http(book: Book, nas: Path) -> None:
    with web(nas) as place:
        assert push(book.folder, f"{place}/nas").sent
        assert not push(book.folder, f"{place}/nas").sent
        with pytest.raises(PushFailed, match="could not push to http://127"):
            push(book.folder, f"{place}/other")
    assert git(nas, "show", "main:press.json").encode() == ONE.to_bytes()


class Locked(Quiet):
    """A server that wants a password."""

    def handle(self) -> None:
        self.raw_requestline = self.rfile.readline(65537)
        if self.parse_request():
            self.send_response(401)
            self.send_header("WWW-Authenticate", 'Basic realm="nas"')
            self.send_header("Content-Length", "0")
            self.end_headers()


def test_one_that_wants_a_password(book: Book, nas: Path, by: str) -> None:
    """Nobody is asked: not on a terminal either, nor in a window."""
    assert nas.exists()
    with make_server("127.0.0.1", 0, lambda *_: [], handler_class=Locked) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
        thread.start()
        try:
            with pytest.raises(PushFailed) as raised:
                push(book.folder, f"http://127.0.0.1:{server.server_port}/nas")
        finally:
            server.shutdown()
            thread.join()
    assert "terminal prompts disabled" in str(raised.value) or by == "dulwich"


@pytest.mark.usefixtures("by")
def test_a_server_that_never_answers(book: Book, nas: Path) -> None:
    assert nas.exists()
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        with pytest.raises(PushFailed, match="could not push to http://127"):
            push(book.folder, f"http://127.0.0.1:{port}/nas", timeout_s=0.05)


@posix
def test_a_silent_one_is_ended_with_all_that_it_started(
    book: Book, nas: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    started = tmp_path / "started"
    ssh = script(tmp_path / "ssh", f"#!/bin/sh\necho $$ > x; mv x {started}\nexec tail -f /dev/null\n")
    hours = itertools.count(step=3600.0)
    clock = SimpleNamespace(perf_counter=lambda: next(hours) if started.exists() else 0.0)
    monkeypatch.setattr(bounded, "time", clock)
    monkeypatch.setattr(bounded, "_LOOK_S", 0.01)
    monkeypatch.setenv("GIT_SSH_COMMAND", str(ssh))
    with pytest.raises(PushFailed, match="git wrote nothing for 8 s; nothing is lost"):
        push(book.folder, f"ssh://nas.invalid{nas}", timeout_s=2)
    process = int(started.read_text())
    while _runs(process):
        time.sleep(0.01)


def _runs(process: int) -> bool:
    """False once it is gone, or waits as a zombie for somebody who asks after it."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    state = subprocess.run(
        ["ps", "-o", "stat=", "-p", str(process)], capture_output=True, text=True, check=False
    )
    return bool(state.stdout.strip()) and not state.stdout.startswith("Z")
