"""Client of a Rugo service: one file, Python 3.8 or later, nothing but the standard library.

    import rugo

    server = rugo.Server("http://127.0.0.1:8080")
    study = server.submit({"name": "first", "kind": "statistics", "realisations": 200,
                           "surface": {"hurst": [0.2, 0.8], "wavelength_ratio": 8, "length_ratio": 8}})
    study.wait()
    for row in study.curves("summit_height_pdf"):
        print(row["case"], row["x"], row["y"], row["standard_error"])

Curves and tables are Rows: lists of dicts, whose frame() is a pandas.DataFrame where pandas is installed.
Server.study() takes the id of a study, the first digits of it, or its name. What the service refuses raises
RugoError with all that it said.
"""

import csv
import gzip
import hashlib
import http.client
import io
import ipaddress
import json
import os
import secrets
import ssl
import stat
import sys
import time
import urllib.error
import urllib.parse
import urllib.request

__all__ = ["Server", "Study", "Rows", "RugoError"]

CSV_CASES_MOST = 64  # of one answer; each case of a larger study is asked for by itself
MAIN_SERIES = "main"  # in rows, of a curve that is the only one of its quantity: pandas drops rows without a name
SNAPSHOT_SILENCE = 300  # seconds
AWAY = (None, 502, 503, 504)  # statuses of answers that are none of the service, or say that it is busy
ENDS = ("done", "failed", "cancelled")
# What the package rugo has besides, whose name this file may have.
IN_PACKAGE = ("LibraryError", "Pressed", "Result", "characterise", "choices", "detrend", "generate", "library_version", "press",
              "psd", "run", "summits", "surface")


def __getattr__(name):
    """Explains what is missing where this file, as rugo.py, hides the package."""
    if name in IN_PACKAGE and "." not in __name__:
        raise AttributeError(f"{__file__} is the client of a Rugo service; the package rugo has {name!r}: rename the file, "
                             "e.g. to rugo_client.py, or take it out of the way")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


class RugoError(Exception):
    """What went wrong: `status` of HTTP (None: no answer came), `detail`, and `errors`, a list of dicts
    with `pointer` and `detail`."""

    def __init__(self, status, detail, errors=()):
        self.status, self.detail, self.errors = status, detail, list(errors)
        self.lost = status in (502, 504)  # it may have been done: no answer of the service came
        lines = [f"{error.get('pointer', '')}: {error.get('detail', '')}" for error in self.errors]
        super().__init__("\n  ".join([detail] + lines))


class Rows(list):
    """A list of dicts, one a row."""

    def frame(self):
        """The rows as a pandas.DataFrame; ImportError where there is no pandas."""
        import pandas

        return pandas.DataFrame(list(self))


def _value(text):
    """What a cell of CSV says: a number, None for an empty one, or the text."""
    if text == "" or text is None:
        return None
    for kind in (int, float):
        try:
            return kind(text)
        except ValueError:
            pass
    return text


def rows_of_csv(text):
    """The rows of a CSV text, whose lines before the header may be comments; a series without a name is "main"."""
    lines = [line for line in io.StringIO(text) if not line.startswith("#")]
    rows = Rows({name: _value(cell) for name, cell in row.items()} for row in csv.DictReader(lines))
    for row in rows:
        if row.get("series", MAIN_SERIES) is None:
            row["series"] = MAIN_SERIES
    return rows


def _parameter_names(pointers, swept):
    """The columns of parameters by pointer: the last word where it is the only one, of what is swept and then of the rest; else
    the pointer without its first slash."""
    of_swept = [pointer for pointer in pointers if any((pointer + "/").startswith(one + "/") for one in swept)]
    rest = [pointer for pointer in pointers if pointer not in of_swept]
    words, names = set(), {}
    for group in (of_swept, rest):
        last = [pointer.rsplit("/", 1)[1] for pointer in group]
        names.update({pointer: word if last.count(word) == 1 and word not in words else pointer[1:]
                      for pointer, word in zip(group, last)})
        words.update(last)
    return names


def rows_of_scalars(document):
    """The rows of the scalars of a document of curves."""
    rows = Rows()
    pointers = dict.fromkeys(pointer for one in document["cases"] for pointer in one["parameters"])
    names = _parameter_names(list(pointers), document.get("swept") or ())
    for one in document["cases"]:
        parameters = {names[pointer]: value for pointer, value in one["parameters"].items()}
        for name, scalar in one.get("scalars", {}).items():
            rows.append({"case": one["case"], **parameters, "name": name, **scalar})
    return rows


def _token_of_file(path):
    """The first token of a file that may submit, else the first: role:token, role:name:token or a token a line.
    Digests, which servers check, are no tokens."""
    first = None
    with open(path, encoding="utf-8") as file:
        about = os.fstat(file.fileno())
        if os.name == "posix" and stat.S_ISREG(about.st_mode) and \
                about.st_mode & (0o77 if about.st_uid == os.geteuid() else 0o7):
            raise ValueError(f"{path} holds secrets and is open to others; chmod 600 {path} makes it its owner's alone")
        for line in file:
            line = line.strip()
            if line == "" or line.startswith("#"):
                continue
            role, colon, rest = line.partition(":")
            known = colon and role in ("read", "submit", "work", "admin")
            token = rest.split(":", 1)[-1] if known else line  # behind the name, where there is one
            if known and any(text.startswith("sha256:") and len(text) == 71 for text in (rest, token)):
                continue
            if not known or role in ("submit", "admin"):
                return token
            first = first or token
    if first is None:
        raise ValueError(f"{path} holds no token")
    return first


def _content(der, at):
    """Where the content of an element of DER begins and ends (X.690, 8.1)."""
    length, begin = der[at + 1], at + 2
    if length >= 0x80:
        width = length & 0x7F
        length, begin = int.from_bytes(der[begin:begin + width], "big"), begin + width
    return begin, begin + length


def _fingerprint(certificate):
    """The digest of the public key of a certificate, in DER, as `rugo serve` prints it (RFC 5280, 4.1)."""
    at, _ = _content(certificate, _content(certificate, 0)[0])
    if certificate[at] == 0xA0:  # the version
        at = _content(certificate, at)[1]
    for _ in range(5):  # serial number, signature, issuer, validity, subject
        at = _content(certificate, at)[1]
    return "sha256:" + hashlib.sha256(certificate[at:_content(certificate, at)[1]]).hexdigest()


class _Whole(http.client.HTTPResponse):
    """An answer whose read() raises IncompleteRead where the connection ends before its length, with a size, too."""

    def read(self, size=None):
        part = super().read(size)
        if not part and size != 0 and self.length:
            raise http.client.IncompleteRead(part, self.length)
        return part


class _Plain(urllib.request.HTTPHandler):
    """Connections without TLS."""

    def http_open(self, request):
        class Connection(http.client.HTTPConnection):
            response_class = _Whole

        return self.do_open(Connection, request)


class _Tls(urllib.request.HTTPSHandler):
    """Connections to those whom a file of authorities vouches for, or whose key has a fingerprint."""

    def __init__(self, ca_file, fingerprint):
        self.trust = ssl.create_default_context(cafile=ca_file)
        self.trust.minimum_version = ssl.TLSVersion.TLSv1_2
        self.fingerprint = fingerprint.lower() if fingerprint else None
        if fingerprint:  # the key is known: name and authority add nothing to it
            self.trust.check_hostname, self.trust.verify_mode = False, ssl.CERT_NONE
        super().__init__(context=self.trust)

    def https_open(self, request):
        wanted = self.fingerprint

        class Connection(http.client.HTTPSConnection):
            response_class = _Whole

            def connect(self):
                super().connect()
                if wanted and _fingerprint(self.sock.getpeercert(binary_form=True)) != wanted:
                    self.close()
                    raise ssl.SSLError(1, "the server's key has another fingerprint: nothing was sent")

        return self.do_open(Connection, request, context=self.trust)


class _NoRedirect(urllib.request.HTTPRedirectHandler):
    """A token is not for wherever an answer points."""

    def redirect_request(self, *_):
        return None


def _document(study):
    """The JSON of a study: a dict, JSON text, or the path of a file of it."""
    if isinstance(study, os.PathLike) or (isinstance(study, str) and not study.lstrip().startswith("{")):
        with open(study, encoding="utf-8") as file:
            study = file.read()
    return study if isinstance(study, str) else json.dumps(study)


def _listed(given):
    """What may be one or several, as a list: a text or a path is one."""
    return [given] if isinstance(given, (str, os.PathLike)) else list(given)


def _form(files, study=None):
    """Files, and perhaps a study, as a form, as browsers send them: its bytes and their media type."""
    boundary, parts = secrets.token_hex(16), []
    for path in _listed(files):
        name = os.path.basename(os.fspath(path)).replace('"', "%22")
        with open(path, "rb") as opened:
            parts.append((f'name="map"; filename="{name}"', opened.read()))
    if study is not None:
        parts.append(('name="study"', study.encode("utf-8")))
    lines = [f"--{boundary}\r\nContent-Disposition: form-data; {said}\r\n\r\n".encode("utf-8") + content + b"\r\n"
             for said, content in parts]
    return b"".join(lines) + f"--{boundary}--\r\n".encode("ascii"), "multipart/form-data; boundary=" + boundary


def _is_here(host):
    try:
        return host == "localhost" or ipaddress.ip_address(host or "").is_loopback
    except ValueError:
        return False


class Server:
    """A service at a URL. token: as the service knows it; else of token_file, else of RUGO_TOKEN, else none.
    https: ca_file, else RUGO_CA_FILE, has who vouches for it, or fingerprint, else RUGO_FINGERPRINT, is that of
    its key as it prints it; else the system's authorities vouch. insecure: a token may cross a network in clear
    text. timeout: seconds of silence, and for changes until there is an answer."""

    def __init__(self, url="http://127.0.0.1:8080", token=None, token_file=None, timeout=60, ca_file=None,
                 fingerprint=None, insecure=False):
        self.url = url.rstrip("/")
        self.token = token or (_token_of_file(token_file) if token_file else os.environ.get("RUGO_TOKEN"))
        self.timeout = timeout
        parts = urllib.parse.urlsplit(self.url)
        if self.token and parts.scheme != "https" and not insecure and not _is_here(parts.hostname):
            raise ValueError(f"{url} would get the token in clear text over the network: use https://")
        if not ca_file and not fingerprint:
            ca_file, fingerprint = os.environ.get("RUGO_CA_FILE"), os.environ.get("RUGO_FINGERPRINT")
        direct = [urllib.request.ProxyHandler({})] if _is_here(parts.hostname) else []  # no token leaves this machine
        self._open = urllib.request.build_opener(_Plain, _Tls(ca_file, fingerprint), _NoRedirect, *direct).open

    def ask(self, method, path, query=None, body=None, accept="application/json", headers=None, timeout=None):
        """One request; the open answer, whose read() gives bytes as they were before compression."""
        pairs = {name: value for name, value in (query or {}).items() if value is not None}
        url = self.url + path + ("?" + urllib.parse.urlencode(pairs) if pairs else "")
        request = urllib.request.Request(url, data=body, method=method)
        request.add_header("Accept", accept)
        request.add_header("Accept-Encoding", "gzip")
        if self.token:
            request.add_header("Authorization", "Bearer " + self.token)
        if body is not None:
            request.add_header("Content-Type", "application/json")
        for name, value in (headers or {}).items():
            request.add_header(name, value)
        try:
            answer = self._open(request, timeout=timeout or self.timeout)
        except urllib.error.HTTPError as error:
            raise _problem(error) from None
        except (OSError, http.client.HTTPException) as error:
            raise _no_answer(self.url, error) from error
        if "Rugo-Version" not in answer.headers:
            answer.close()
            raise RugoError(None, f"{self.url} is no server of Rugo: its answer, of status {answer.status}, is not one of rugo serve")
        return gzip.GzipFile(fileobj=answer) if answer.headers.get("Content-Encoding") == "gzip" else answer

    def text(self, method, path, **more):
        with self.ask(method, path, **more) as answer:
            try:
                return answer.read().decode("utf-8")
            except (OSError, EOFError, http.client.HTTPException) as error:
                raise _no_answer(self.url, error) from error

    def json(self, method, path, **more):
        return json.loads(self.text(method, path, **more))

    def change(self, method, path, key=None, **more):
        """A request that changes something, as text: with one key it is sent until it is answered."""
        headers = {"Idempotency-Key": key or secrets.token_hex(16)}
        until, pause, lost = time.monotonic() + self.timeout, 0.2, False
        while True:
            try:
                return self.text(method, path, headers=headers, **more)
            except RugoError as error:
                lost = lost or error.lost
                again = lost and (error.status is None or error.status >= 500)
                if not again:
                    error.lost = lost  # what it did the first time may be why it is refused now
                    raise
                if time.monotonic() + pause > until:
                    detail = f"{error.detail}; it may have been done all the same"
                    raise RugoError(None, f"{detail}: the key was {headers['Idempotency-Key']}") from error
            time.sleep(pause)
            pause = min(2 * pause, 2)

    def submit(self, study, key=None):
        """Queues a study: a dict, JSON text, or the path of a file of it. The same key gives the same study."""
        answer = json.loads(self.change("POST", "/v1/studies", key, body=_document(study).encode("utf-8")))
        return Study(self, answer["id"])

    def study(self, name, unique=False):
        """The study with this id, else the newest of this name, else that with these first digits of its id. unique:
        a name that several studies have is refused, with their ids, as it is for cancel and delete of what a name
        found."""
        path = "/v1/studies/" + urllib.parse.quote(name, safe="")
        status = self.json("GET", path, query={"unique": "true" if unique else None})
        return Study(self, status["id"], found_by=name)

    def studies(self):
        """The progress of all studies, oldest first, as dicts."""
        rows, after = Rows(), None
        while True:
            page = self.json("GET", "/v1/studies", query={"limit": 1000, "after": after})
            rows.extend(page["studies"])
            after = page.get("next")
            if after is None or not page["studies"]:
                return rows

    def characterise(self, file, name=None, format="json", **options):
        """What a map in a file (a path, or bytes with a name) is like: a dict of groups; format="svg": the page about it,
        as text; "study": a study of surfaces like it, for submit. options: layer, columns, dx, unit, z_unit, missing, crop, stride, lines,
        lines_along, despike, deconvolve, transpose, rotate, detrend, degroove, fill, denoise, filter, resample, window, boundary, trust_from, trust_to, hold,
        as of rugo characterise. A list of paths: maps of one surface together."""
        if isinstance(file, (list, tuple)):
            return self._characterised(_form(file), format, dict(options, together=True))
        if not isinstance(file, (bytes, bytearray)):
            name = name or os.path.basename(os.fspath(file))
            with open(file, "rb") as opened:
                file = opened.read()
        if not name:
            raise ValueError("bytes need the name of their file, such as name='patch.x3p'")
        return self._characterised((bytes(file), "application/octet-stream"), format, dict(options, name=name))

    def _characterised(self, sent, format, options):
        query = {key: str(value).lower() if isinstance(value, bool) else value for key, value in options.items()}
        text = self.text("POST", "/v1/characterise", query=dict(query, format=format), body=sent[0],
                         headers={"Content-Type": sent[1]})
        return text if format == "svg" else json.loads(text)

    def fit(self, study, files):
        """The study (a dict, JSON or a path, as for submit) with what is fitted to the files that its /surface/like
        names, which are sent: a path or several, of which the study has the last part. It needs no file any more."""
        return self._characterised(_form(files, _document(study)), "study", {})

    def _parts(self, answer):
        """The parts of an answer, to its end; RugoError where it does not come whole."""
        data = True
        while data:
            try:
                data = answer.read(1 << 16)
            except (OSError, EOFError, http.client.HTTPException) as error:
                raise _no_answer(self.url, error) from error
            yield data

    def snapshot(self, path):
        """Copies the database of the service to a file, for SQLite and pandas.read_sql. The file is there, in place of
        one of that name, when it is whole. The service copies it before it answers: five minutes of silence at least are
        waited for."""
        part = f"{path}.part-{os.urandom(3).hex()}"
        try:
            with open(part, "xb") as file, self.ask("GET", "/v1/snapshot", accept="*/*",
                                                        timeout=max(self.timeout, SNAPSHOT_SILENCE)) as answer:
                for data in self._parts(answer):
                    file.write(data)
            os.replace(part, path)
        except BaseException:
            if os.path.exists(part):
                os.unlink(part)
            raise
        return path


def _no_answer(url, error):
    """A RugoError of a request without an answer; what was refused before it was sent is not lost."""
    cut = isinstance(error, (EOFError, http.client.IncompleteRead))
    reason = "the answer was cut off" if cut else getattr(error, "reason", error)
    told = RugoError(None, f"{url}: {reason}")
    told.lost = not isinstance(reason, (ConnectionRefusedError, ssl.SSLError)) and not (
        isinstance(reason, OSError) and reason.__class__.__name__ == "gaierror")
    return told


def _problem(error):
    """A RugoError of an answer that refuses, whose reason may have been cut off."""
    try:
        text = error.read()
        if error.headers.get("Content-Encoding") == "gzip":
            text = gzip.decompress(text)
        problem = json.loads(text)
        return RugoError(error.code, problem["detail"], problem.get("errors", ()))
    except (ValueError, KeyError, TypeError, OSError, EOFError, http.client.HTTPException):
        return RugoError(error.code, f"HTTP status {error.code}")


class Study:
    """A study of a service."""

    def __init__(self, server, id, found_by=None):
        self.server, self.id, self._found_by = server, id, found_by

    def __repr__(self):
        return f"Study({self.id})"

    def _require_unique(self):
        """Refuses to lose one of several studies of the name by which this one was found."""
        if self._found_by is not None:
            self.server.study(self._found_by, unique=True)
            self._found_by = None

    def _path(self, rest=""):
        return f"/v1/studies/{self.id}{rest}"

    def status(self):
        """State, counts, share of the work done, seconds left, failures: a dict."""
        return self.server.json("GET", self._path())

    def document(self):
        """The study as it was submitted: a dict."""
        return self.server.json("GET", self._path("/study"))

    def wait(self, timeout=None, progress=False):
        """Returns when the study is done. RugoError where it failed or was cancelled, or has not a single value;
        TimeoutError after so many seconds. A service that is away is asked again. progress: a line a look on
        standard error."""
        begin, pause, known = time.monotonic(), 0.1, False
        while True:
            try:
                status, known = self.status(), True
            except RugoError as error:
                if not known or error.status not in AWAY:
                    raise
                status = None
            if status is not None:
                if progress:
                    _tell(status)
                if status["state"] in ENDS:
                    return self._ended(status)
            if timeout is not None and time.monotonic() - begin > timeout:
                raise TimeoutError(f"study {self.id} has not ended within {timeout} s")
            time.sleep(pause)
            pause = min(1.5 * pause, 2)

    def _ended(self, status):
        if status["state"] != "done":
            reasons = [failure["reason"] for failure in status["failures"]]
            raise RugoError(None, f"study {self.id} is {status['state']}", [{"detail": text} for text in reasons])
        if 0 < status["cases"] <= status.get("cases_valueless", 0):
            raise RugoError(None, f"study {self.id}: no realisation has a value: {status['valueless_note']}")
        return self

    def curves(self, quantity=None, case=None):
        """A row a point of each curve (of one quantity, of one case): case, quantity, x, y, errors, theories,
        total_low and total_high (where the truth lies, to 95 %) and unknown_errors (what these leave out)."""
        numbers = [case]
        if case is None and self.status()["cases"] > CSV_CASES_MOST:
            numbers = range(self.status()["cases"])
        rows = Rows()
        for number in numbers:
            query = {"quantity": quantity, "case": number}
            rows.extend(rows_of_csv(self.server.text("GET", self._path("/curves"), query=query, accept="text/csv")))
        return rows

    def table(self, columns=None, where=None):
        """A row a case: what the study sweeps, then scalars ("kappa") or values of curves ("mean_gap@0.1") with
        their errors; columns: one or a list of these, where: a dict such as {"hurst": 0.8}, or lists of values."""
        pairs = [(name, value) for name, given in (where or {}).items()
                 for value in (given if isinstance(given, (list, tuple)) else [given])]
        query = {"columns": ",".join(_listed(columns)) if columns else None,
                 "where": ",".join(f"{name}={value}" for name, value in pairs) or None}
        return rows_of_csv(self.server.text("GET", self._path("/table"), query=query, accept="text/csv"))

    def results(self, quantity=None, case=None):
        """Curves, scalars, parameters and notes of the cases, as the service's document: a dict."""
        return self.server.json("GET", self._path("/curves"), query={"quantity": quantity, "case": case})

    def scalars(self):
        """A row a case and scalar: case, its parameters (by the last word, where several have it by the pointer without
        its first slash), name, value, standard_error, theory, total_low, total_high and
        a list unknown_errors."""
        return rows_of_scalars(self.results())

    def report(self):
        """Cost beside error, by case: a dict."""
        return self.server.json("GET", self._path("/report"))

    def plot(self, quantity, **query):
        """A picture, as SVG text; query: x, colour, case, difference."""
        return self.server.text("GET", self._path("/plot"), query={"quantity": quantity, **query}, accept="*/*")

    def extend(self, realisations):
        """Queues what is missing to so many realisations of each case."""
        body = json.dumps({"realisations": realisations}).encode("utf-8")
        self.server.change("POST", self._path("/extend"), body=body)
        return self

    def cancel(self):
        """Cancels the study, which has not ended."""
        self._require_unique()
        try:
            self.server.change("DELETE", self._path())
        except RugoError as error:
            if not (error.lost and error.status == 409 and self.status()["state"] == "cancelled"):
                raise
        return self

    def retry(self):
        self.server.change("POST", self._path("/retry"))
        return self

    def delete(self):
        """Deletes the study, which has ended, with its results."""
        self._require_unique()
        try:
            self.server.change("DELETE", self._path(), query={"results": "true"})
        except RugoError as error:
            if not (error.lost and error.status == 404):
                raise


def _tell(status):
    left = status.get("seconds_left")
    print(f"{status['name']}: {status['state']}, {100 * status.get('share', 0):.1f} %, "
          f"{'-' if left is None else round(left)} s left", file=sys.stderr)
