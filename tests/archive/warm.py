"""Puts a file of a wheel into rocrate-validator's cache, as if it had been fetched: warm.py CACHE URL WHEEL MEMBER."""

import io
import sys
import zipfile

from requests.adapters import BaseAdapter, HTTPAdapter
from requests_cache import CachedSession
from urllib3 import HTTPResponse


class FromMemory(BaseAdapter):
    """Answers every request with the same document."""

    def __init__(self, document):
        super().__init__()
        self.document = document

    def send(self, request, **_):
        response = HTTPResponse(
            body=io.BytesIO(self.document),
            status=200,
            headers={"Content-Type": "application/ld+json"},
            preload_content=False,
            request_method="GET",
            request_url=request.url,
        )
        return HTTPAdapter().build_response(request, response)

    def close(self):
        pass


def main():
    cache, url, wheel, member = sys.argv[1:]
    document = zipfile.ZipFile(wheel).read(member)
    # The settings and the header are those that the validator asks with: they are part of the cache's key.
    cached = CachedSession(cache, backend="sqlite", expire_after=-1, allowable_methods=("GET",))
    cached.mount("https://", FromMemory(document))
    accepted = "application/ld+json, application/json, */*;q=0.1"
    cached.get(url, headers={"Accept": accepted}).raise_for_status()


main()
