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
import io
import json
import os
import shutil
import sys
import time
import urllib.error
import urllib.parse
import urllib.request

__all__ = ["Server", "Study", "Rows", "RugoError"]

CSV_CASES_MOST = 64  # of one answer; each case of a larger study is asked for by itself
ENDS = ("done", "failed", "cancelled")


class RugoError(Exception):
    """What went wrong: `status` of HTTP (None: no answer came), `detail`, and `errors`, a list of dicts
    with `pointer` and `detail`."""

    def __init__(self, status, detail, errors=()):
        self.status, self.detail, self.errors = status, detail, list(errors)
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


def _rows(text):
    """The rows of a CSV text, whose lines before the header may be comments."""
    lines = [line for line in io.StringIO(text) if not line.startswith("#")]
    return Rows({name: _value(cell) for name, cell in row.items()} for row in csv.DictReader(lines))


def _token_of_file(path):
    """The first token of a file that may submit, else the first: role:token, role:name:token or a token a line."""
    first = None
    with open(path, encoding="utf-8") as file:
        for line in file:
            line = line.strip()
            if line == "" or line.startswith("#"):
                continue
            role, colon, rest = line.partition(":")
            known = colon and role in ("read", "submit", "work", "admin")
            token = rest.split(":", 1)[-1] if known else line  # behind the name, where there is one
            if not known or role in ("submit", "admin"):
                return token
            first = first or token
    if first is None:
        raise ValueError(f"{path} holds no token")
    return first


class Server:
    """A service at a URL. token: as the service knows it; else of token_file, else of RUGO_TOKEN, else none."""

    def __init__(self, url="http://127.0.0.1:8080", token=None, token_file=None, timeout=60):
        self.url = url.rstrip("/")
        self.token = token or (_token_of_file(token_file) if token_file else os.environ.get("RUGO_TOKEN"))
        self.timeout = timeout  # seconds

    def ask(self, method, path, query=None, body=None, accept="application/json", headers=None):
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
            answer = urllib.request.urlopen(request, timeout=self.timeout)
        except urllib.error.HTTPError as error:
            raise _problem(error) from None
        except OSError as error:
            raise RugoError(None, f"{self.url}: {getattr(error, 'reason', error)}") from error
        return gzip.GzipFile(fileobj=answer) if answer.headers.get("Content-Encoding") == "gzip" else answer

    def text(self, method, path, **more):
        with self.ask(method, path, **more) as answer:
            return answer.read().decode("utf-8")

    def json(self, method, path, **more):
        return json.loads(self.text(method, path, **more))

    def submit(self, study, key=None):
        """Queues a study: a dict, JSON text, or the path of a file of it. The same key gives the same study."""
        if isinstance(study, str) and not study.lstrip().startswith("{"):
            with open(study, encoding="utf-8") as file:
                study = file.read()
        text = study if isinstance(study, str) else json.dumps(study)
        headers = {"Idempotency-Key": key} if key else None
        answer = self.json("POST", "/v1/studies", body=text.encode("utf-8"), headers=headers)
        return Study(self, answer["id"])

    def study(self, name):
        """The study with this id, these first digits of an id, or this name."""
        return Study(self, self.json("GET", "/v1/studies/" + urllib.parse.quote(name, safe=""))["id"])

    def studies(self):
        """The progress of all studies, oldest first, as dicts."""
        rows, after = Rows(), None
        while True:
            page = self.json("GET", "/v1/studies", query={"limit": 1000, "after": after})
            rows.extend(page["studies"])
            after = page.get("next")
            if after is None or not page["studies"]:
                return rows

    def snapshot(self, path):
        """Copies the database of the service to a file, for SQLite and pandas.read_sql."""
        with self.ask("GET", "/v1/snapshot", accept="*/*") as answer, open(path, "wb") as file:
            shutil.copyfileobj(answer, file)
        return path


def _problem(error):
    """A RugoError of an answer that refuses."""
    text = error.read()
    if error.headers.get("Content-Encoding") == "gzip":
        text = gzip.decompress(text)
    try:
        problem = json.loads(text)
        return RugoError(error.code, problem["detail"], problem.get("errors", ()))
    except (ValueError, KeyError, TypeError):
        return RugoError(error.code, f"HTTP status {error.code}")


class Study:
    """A study of a service."""

    def __init__(self, server, id):
        self.server, self.id = server, id

    def __repr__(self):
        return f"Study({self.id})"

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
                if not known or error.status not in (None, 503):
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
        """A row a point of each curve (of one quantity, of one case): case, quantity, x, y, errors, theories."""
        numbers = [case]
        if case is None and self.status()["cases"] > CSV_CASES_MOST:
            numbers = range(self.status()["cases"])
        rows = Rows()
        for number in numbers:
            query = {"quantity": quantity, "case": number}
            rows.extend(_rows(self.server.text("GET", self._path("/curves"), query=query, accept="text/csv")))
        return rows

    def table(self, columns=None, where=None):
        """A row a case: what the study sweeps, then scalars ("kappa") or values of curves ("mean_gap@0.1") with
        their errors; columns: a list of these, where: a dict such as {"hurst": 0.8}, or lists of values."""
        pairs = [(name, value) for name, given in (where or {}).items()
                 for value in (given if isinstance(given, (list, tuple)) else [given])]
        query = {"columns": ",".join(columns) if columns else None,
                 "where": ",".join(f"{name}={value}" for name, value in pairs) or None}
        return _rows(self.server.text("GET", self._path("/table"), query=query, accept="text/csv"))

    def results(self, quantity=None, case=None):
        """Curves, scalars, parameters and notes of the cases, as the service's document: a dict."""
        return self.server.json("GET", self._path("/curves"), query={"quantity": quantity, "case": case})

    def scalars(self):
        """A row a case and scalar: case, its parameters, name, value, standard_error, theory."""
        rows = Rows()
        for one in self.results()["cases"]:
            parameters = {pointer.rsplit("/", 1)[1]: value for pointer, value in one["parameters"].items()}
            for name, scalar in one.get("scalars", {}).items():
                rows.append({"case": one["case"], **parameters, "name": name, **scalar})
        return rows

    def report(self):
        """Cost beside error, by case: a dict."""
        return self.server.json("GET", self._path("/report"))

    def plot(self, quantity, **query):
        """A picture, as SVG text; query: x, colour, case, difference."""
        return self.server.text("GET", self._path("/plot"), query={"quantity": quantity, **query}, accept="*/*")

    def extend(self, realisations):
        """Queues what is missing to so many realisations of each case."""
        body = json.dumps({"realisations": realisations}).encode("utf-8")
        self.server.json("POST", self._path("/extend"), body=body)
        return self

    def cancel(self):
        self.server.json("DELETE", self._path())
        return self

    def retry(self):
        self.server.json("POST", self._path("/retry"))
        return self

    def delete(self):
        """Deletes the study, which has ended, with its results."""
        self.server.text("DELETE", self._path(), query={"results": "true"})


def _tell(status):
    left = status.get("seconds_left")
    print(f"{status['name']}: {status['state']}, {100 * status.get('share', 0):.1f} %, "
          f"{'-' if left is None else round(left)} s left", file=sys.stderr)
