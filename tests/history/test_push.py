"""A copy in another repository: by folder, ssh and http; what fails is told, and nothing here is lost."""

from __future__ import annotations

import socket
import stat
import sys
import threading
from contextlib import contextmanager
from typing import TYPE_CHECKING
from wsgiref.simple_server import WSGIRequestHandler, make_server

import pytest
from dulwich.repo import Repo
from dulwich.server import BackendRepo, DictBackend
from dulwich.web import make_wsgi_chain

from fatektool.errors import PushFailed
from fatektool.history.push import push

from .books import ONE, THREE, TWO, Book, git

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

SSH = """#!/bin/sh
# ssh HOST COMMAND, where HOST is this computer
for word; do last=$word; done
printf '%s\\n' "$*" > "$0.said"
exec sh -c "$last"
"""


@pytest.fixture
def nas(book: Book, tmp_path: Path) -> Path:
    assert book.record("press", ONE)
    git(tmp_path, "init", "--quiet", "--bare", "--initial-branch=master", "nas")
    return tmp_path / "nas"


@pytest.mark.parametrize("form", ["{0}", "nas", "file://{0}", "NAS"])
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


def test_nothing_yet(nas: Path, tmp_path: Path) -> None:
    git(tmp_path, "init", "--quiet", "--bare", "empty")
    found = push(tmp_path / "empty", str(nas))
    assert (found.revision, found.sent) == (None, False)


def test_one_that_has_gone_another_way(book: Book, nas: Path, tmp_path: Path) -> None:
    other = Book(tmp_path / "other")
    other.record("saw", ONE)
    push(other.folder, str(nas))
    before = git(nas, "rev-parse", "main")
    with pytest.raises(
        PushFailed, match=r"has gone another way: its refs/heads/main is .*nothing was pushed"
    ):
        push(book.folder, str(nas))
    assert git(nas, "rev-parse", "main") == before
    assert book.record("press", TWO)[0].revision


def test_one_that_is_ahead(book: Book, nas: Path, tmp_path: Path) -> None:
    push(book.folder, str(nas))
    git(tmp_path, "clone", "--quiet", "--bare", str(nas), "copy")
    Book(tmp_path / "copy").record("press", TWO)
    push(tmp_path / "copy", str(nas))
    with pytest.raises(PushFailed, match="has gone another way"):
        push(book.folder, str(nas))


@pytest.mark.parametrize(
    ("remote", "message"),
    [
        ("nowhere", "could not push to nowhere: there is no such folder"),
        ("git://127.0.0.1/x", "could not push to git://127.0.0.1/x: expected a folder, http://"),
        ("http://user:secret@127.0.0.1:1/x", "could not push to http://127.0.0.1:1/x: "),
        ("work", "it has a work tree, expected a bare repository"),
        (".", "could not push to .: NotGitRepository"),
    ],
)
def test_no_place_to_push_to(book: Book, nas: Path, tmp_path: Path, remote: str, message: str) -> None:
    assert nas.exists()
    git(tmp_path, "init", "--quiet", "work")
    with pytest.raises(PushFailed) as raised:
        push(book.folder, remote, timeout_s=0.2)
    assert message in str(raised.value)
    assert "secret" not in str(raised.value)
    assert raised.value.exit_code == 3
    assert "\n" not in str(raised.value)


@pytest.mark.skipif(sys.platform == "win32", reason="stands in for ssh with a shell script")
def test_by_ssh(book: Book, nas: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ssh = tmp_path / "ssh"
    ssh.write_text(SSH, encoding="utf-8")
    ssh.chmod(stat.S_IRWXU)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    for remote, new in ((f"ssh://me@nas.invalid{nas}", TWO), (f"me@nas.invalid:{nas}", THREE)):
        assert push(book.folder, remote).sent
        said = (tmp_path / "ssh.said").read_text(encoding="utf-8")
        assert said.startswith("-o BatchMode=yes -o ConnectTimeout=30 ")
        assert "me@nas.invalid git-receive-pack" in said
        book.record("press", new)
    (nas / "hooks" / "pre-receive").write_text("#!/bin/sh\nexit 1\n", encoding="utf-8")
    (nas / "hooks" / "pre-receive").chmod(stat.S_IRWXU)
    with pytest.raises(PushFailed, match="pre-receive hook declined"):
        push(book.folder, f"ssh://nas.invalid{nas}")
    ssh.write_text("#!/bin/sh\necho 'Permission denied (publickey).' >&2\nexit 255\n", encoding="utf-8")
    with pytest.raises(PushFailed, match=r"could not push to ssh://nas\.invalid"):
        push(book.folder, f"ssh://nas.invalid{nas}")


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


def test_by_http(book: Book, nas: Path) -> None:
    with web(nas) as place:
        assert push(book.folder, f"{place}/nas").sent
        assert not push(book.folder, f"{place}/nas").sent
        with pytest.raises(PushFailed, match="could not push to http://127"):
            push(book.folder, f"{place}/other")
    assert git(nas, "show", "main:press.json").encode() == ONE.to_bytes()


def test_a_server_that_never_answers(book: Book, nas: Path) -> None:
    assert nas.exists()
    with socket.create_server(("127.0.0.1", 0)) as server:
        port = server.getsockname()[1]
        with pytest.raises(PushFailed, match="could not push to http://127"):
            push(book.folder, f"http://127.0.0.1:{port}/nas", timeout_s=0.05)
