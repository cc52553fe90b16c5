"""What test_python.c runs: the client alone, as rugo.py, against a real service. Arguments: the URL, and a folder."""

import contextlib
import gzip
import io
import json
import os
import pathlib
import socket
import sys
import threading

import rugo

URL, FOLDER = sys.argv[1], sys.argv[2]
STUDY = {"name": "again", "kind": "statistics", "seed": 1, "realisations": 8,
         "surface": {"hurst": [0.2, 0.8], "wavelength_ratio": 4, "length_ratio": 4},
         "statistics": {"bins": {"height": [-4, 8, 120], "curvature": [-16, 0, 16]}}}


def refused(call, status, *words):
    try:
        call()
    except rugo.RugoError as error:
        assert error.status == status, error
        assert all(word in str(error) for word in words), error
        return error
    raise AssertionError(f"not refused: {words}")


def a_study_from_submission_to_tables(server):
    path = pathlib.Path(FOLDER, "client-study.json")
    path.write_text(json.dumps(STUDY), encoding="utf-8")
    study = server.submit(path, key="a-key")
    assert server.submit(str(path), key="a-key").id == study.id
    path.unlink()
    assert server.submit(STUDY, key="other").id != study.id
    assert server.submit(json.dumps(STUDY), key="a-key").id == study.id
    with contextlib.redirect_stderr(io.StringIO()) as told:
        assert study.wait(timeout=300, progress=True) is study
    assert "again: done, 100.0 %" in told.getvalue()
    assert study.status()["realisations"]["done"] == 16
    assert study.document()["surface"] == STUDY["surface"]
    rows = study.curves("summit_height_pdf")
    assert {row["case"] for row in rows} == {0, 1} and {row["quantity"] for row in rows} == {"summit_height_pdf"}
    assert {row["series"] for row in rows} == {"main"}
    document = study.results("summit_height_pdf")
    points = [y for case in document["cases"] for curve in case["curves"] for y in curve["y"]]
    assert [row["y"] for row in rows] == points and len(points) > 100
    assert study.curves("summit_height_pdf", case=1) == [row for row in rows if row["case"] == 1]
    slopes = [row for row in study.scalars() if row["name"] == "rms_slope"]
    assert [row["hurst"] for row in slopes] == [0.2, 0.8] and slopes[0]["value"] > slopes[1]["value"]
    table = study.table(["rms_slope"])
    assert [row["hurst"] for row in table] == [0.2, 0.8] and table == study.table("rms_slope")
    assert [row["rms_slope"] for row in table] == [row["value"] for row in slopes]
    assert [row["hurst"] for row in study.table(where={"hurst": 0.8})] == [0.8]
    assert study.plot("summit_height_pdf").startswith(("<?xml", "<svg"))
    assert len(study.report()["cases"]) == 2
    try:
        frame = rows.frame()
        assert list(frame.columns) == list(rows[0]) and len(frame) == len(rows)
    except ImportError:
        print("SKIP frame(): there is no pandas")
    return study


def studies_are_found_and_changed(server, study):
    assert server.study(study.id[:9]).id == study.id
    assert server.study("again").id == server.studies()[-1]["id"]
    refused(lambda: server.study("no / such"), 404, "name its id")
    second = server.submit(STUDY).wait(timeout=300)
    newest = server.study(STUDY["name"])
    assert newest.id == second.id != study.id
    refused(newest.delete, 422, study.id)
    refused(lambda: server.study(STUDY["name"], unique=True), 422, second.id)
    server.study(second.id).delete()
    assert server.study(STUDY["name"]).id not in (study.id, second.id)
    assert study.id in [row["id"] for row in server.studies()]
    assert study.extend(10).wait(timeout=300).status()["realisations"]["done"] == 20
    assert study.retry().status()["state"] == "done"
    refused(study.cancel, 409, "already ended")
    large = server.submit(dict(STUDY, name="large", realisations=100000))
    large.cancel()
    refused(large.wait, None, "cancelled")
    large.delete()
    refused(large.status, 404)


def faults_are_told(server):
    faults = refused(lambda: server.submit({"kind": "statistics", "surface": {"hurst": 1.4}}), 422, "1.4 is not in")
    assert "/surface/hurst" in [error["pointer"] for error in faults.errors]
    refused(lambda: rugo.Server("http://127.0.0.1:1").studies(), None, "127.0.0.1:1")


def answering(head, body, of_rugo=True):
    """A server on this machine that answers each request with this and ends the connection."""
    head += b"\r\nRugo-Version: 0.1" if of_rugo else b""
    listening = socket.create_server(("127.0.0.1", 0))

    def serve():
        with contextlib.suppress(OSError):
            while True:
                with listening.accept()[0] as peer:
                    peer.recv(65536)
                    peer.sendall(b"HTTP/1.1 " + head + b"\r\n\r\n" + body)

    threading.Thread(target=serve, daemon=True).start()
    return rugo.Server("http://127.0.0.1:%d" % listening.getsockname()[1], timeout=1)


def answers_that_are_cut_off_are_none():
    """Whatever says how long an answer is: what was there before stays."""
    path, gzipped = pathlib.Path(FOLDER, "copy.db"), gzip.compress(b"hurst,kappa\n0.8,1\n")
    for head, body in ((b"200 OK\r\nContent-Length: 100000", b"x" * 70000), (b"200 OK\r\nContent-Length: 9", b""),
                       (b"200 OK\r\nTransfer-Encoding: chunked", b"4\r\nhalf\r\n"),
                       (b"200 OK\r\nContent-Encoding: gzip\r\nContent-Length: 99", b""),
                       (b"200 OK\r\nContent-Encoding: gzip\r\nContent-Length: %d" % len(gzipped), gzipped[:-1])):
        cut = answering(head, body)
        path.write_text("the good copy")
        for call in (lambda: cut.snapshot(path), rugo.Study(cut, "1").table, cut.studies):
            assert refused(call, None, "the answer was cut off").lost
        assert path.read_text() == "the good copy" and list(path.parent.glob("copy.db.*")) == []
    whole = answering(b"200 OK\r\nContent-Length: 4", b"good")
    assert whole.snapshot(path) == path and path.read_text() == "good"
    assert rugo.Study(answering(b"200 OK\r\nContent-Encoding: gzip", gzipped), "1").table() == [{"hurst": 0.8, "kappa": 1}]
    refused(answering(b"422 No\r\nContent-Length: 99", b"{").studies, 422, "HTTP status 422")
    other = answering(b"200 OK\r\nContent-Type: text/html\r\nContent-Length: 18", b"<html>login</html>", of_rugo=False)
    for call in (lambda: other.snapshot(path), rugo.Study(other, "1").curves, other.studies):
        refused(call, None, "is no server of Rugo")
    assert path.read_text() == "good"
    path.unlink()


def a_proxy_gets_no_request_to_this_machine():
    os.environ["http_proxy"] = "http://127.0.0.1:1"
    try:
        assert len(rugo.Server(URL, token="aaaa").studies()) > 0
    finally:
        del os.environ["http_proxy"]


def a_gateway_that_fails_is_asked_again():
    study = rugo.Study(None, "1")
    said = iter([{"state": "running"}, rugo.RugoError(502, "gateway"), rugo.RugoError(504, "gateway"),
                 {"state": "done", "cases": 1, "cases_valueless": 0}])

    def status():
        one = next(said)
        if isinstance(one, Exception):
            raise one
        return one

    study.status = status
    assert study.wait(timeout=60) is study and next(said, None) is None


def parameters_have_names_of_their_own():
    """What is swept has the last word of its pointer; of others those that share it have the whole one."""
    case = {"case": 0, "scalars": {"m2": {"value": 1}}, "parameters": {
        "/surface/hurst": 0.2, "/counter_surface/hurst": 0.5, "/surface/heights/tolerance": 0.001, "/contact/tolerance": 1e-6, "/surface/rms_slope": 0.1}}
    row, = rugo.rows_of_scalars({"swept": ["/surface/hurst"], "cases": [case]})
    assert row == {"case": 0, "hurst": 0.2, "counter_surface/hurst": 0.5, "surface/heights/tolerance": 0.001, "contact/tolerance": 1e-6,
                   "rms_slope": 0.1, "name": "m2", "value": 1}, row
    row, = rugo.rows_of_scalars({"swept": ["/contact/tolerance", "/surface/heights"], "cases": [case]})
    assert row["contact/tolerance"] == 1e-6 and row["surface/heights/tolerance"] == 0.001 and "tolerance" not in row, row


def many_cases_are_asked_for_one_by_one(server):
    many = dict(STUDY, name="many", realisations=1, statistics={"bins": {"height": [-4, 8, 12], "curvature": [-16, 0, 8]}})
    many["surface"] = dict(STUDY["surface"], length_ratio=2, points_per_wavelength=2,
                           hurst=[round(0.1 + c / 100, 3) for c in range(65)])
    rows = server.submit(many).wait(timeout=300).curves("summit_height_pdf")
    assert {row["case"] for row in rows} == set(range(65))


def maps_are_characterised(server):
    rows = [",".join(str((3 * i + 5 * j * j) % 17) for i in range(24)) for j in range(20)]
    path = pathlib.Path(FOLDER, "client-map.csv")
    path.write_text("\n".join(rows), encoding="utf-8")
    found = server.characterise(path, dx="0.5um", z_unit="nm", detrend="none")
    assert found["preparation"]["file"] == "client-map.csv"
    assert found["grid"]["nx"] == 24 and abs(found["grid"]["dx"] - 0.5e-6) < 1e-15
    assert "<svg" in server.characterise(path.read_bytes(), name="map.csv", format="svg")
    alike = server.characterise(path, dx="0.5um", z_unit="nm", fill=True, format="study")
    assert server.json("POST", "/v1/check", body=json.dumps(alike).encode("utf-8"))["cases"]
    refused(lambda: server.characterise(b"\x00", name="map.csv"), 422, "map.csv")
    refused(lambda: server.characterise(path, colour="red"), 422, "not valid")
    other = pathlib.Path(FOLDER, 'client "map" 2.csv')
    other.write_text("\n".join(reversed(rows)), encoding="utf-8")
    refused(lambda: server.characterise([path, path], dx="0.5um", z_unit="nm"), 422, "two files named client-map.csv")
    one = server.characterise([path, other], dx="0.5um", z_unit="nm", detrend="mean")
    assert list(one["files"].values()) == [path.name, other.name] and one["together"]["maps"] == 2
    study = {"name": "alike", "kind": "statistics", "realisations": 2, "surface": {"hurst": 0.7, "wavelength_ratio": 8, "rms_slope": 0.1,
             "points_per_wavelength": 2, "length_ratio": 8, "like": {"file": path.name, "dx": 1, "detrend": "none"}}}
    fitted = server.fit(study, [path])
    assert fitted["surface"]["like"]["sha256"] and fitted["surface"]["hurst"] == 0.7
    server.submit(fitted).cancel()
    assert server.fit(study, path) == server.fit(study, str(path)) == fitted
    refused(lambda: server.fit(study, [other]), 422, "no file of this name was sent")
    path.unlink()
    other.unlink()


def tokens_are_read_as_commands_do():
    path = pathlib.Path(FOLDER, "client-tokens")
    for text, token in (("# ours\nread:aaaa\nsubmit:bbbb\nwork:cccc\n", "bbbb"), ("\nread:aaaa\nwork:cc\n", "aaaa"),
                        ("work:cccc\nsubmit:anna:b:b\n", "b:b"), ("read:carl:aaaa\nadmin:root:dddd\n", "dddd"),
                        ("read:carl:aaaa\n", "aaaa"), ("alone\n", "alone"), ("no:role\n", "no:role")):
        path.write_text(text)
        path.chmod(0o600)
        assert rugo.Server(URL, token_file=path).token == token
    path.write_text("submit:anna:sha256:" + 64 * "0" + "\nread:sha256:" + 64 * "0" + "\nread:bert:aaaa\n")
    assert rugo.Server(URL, token_file=path).token == "aaaa"
    path.chmod(0o644)
    for call, word in ((lambda: rugo.Server(URL, token_file=path), "chmod 600"),
                       (lambda: rugo.Server("http://127.0.0.1.invalid", token="aaaa"), "clear text")):
        try:
            call()
            raise AssertionError(word)
        except ValueError as error:
            assert word in str(error), error
    assert rugo.Server("http://192.0.2.1", token="aaaa", insecure=True).token == "aaaa"
    path.unlink()


def names_of_the_package_are_explained():
    for name, words in (("press", ("rugo.py is the client", "the package rugo has 'press'", "rugo_client.py")),
                        ("pres", ("has no attribute 'pres'",))):
        try:
            getattr(rugo, name)
            raise AssertionError(name)
        except AttributeError as error:
            assert all(word in str(error) for word in words), error


assert pathlib.Path(rugo.__file__).name == "rugo.py"
names_of_the_package_are_explained()
os.chdir(FOLDER)
here = rugo.Server(URL)
one = a_study_from_submission_to_tables(here)
studies_are_found_and_changed(here, one)
faults_are_told(here)
maps_are_characterised(here)
answers_that_are_cut_off_are_none()
a_proxy_gets_no_request_to_this_machine()
a_gateway_that_fails_is_asked_again()
parameters_have_names_of_their_own()
many_cases_are_asked_for_one_by_one(here)
tokens_are_read_as_commands_do()
print("client: all as it should be")
