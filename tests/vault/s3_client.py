"""A small S3 client of the test's own: it shares no code with the program's."""
import datetime
import hashlib
import hmac
import http.client
import urllib.parse
import xml.etree.ElementTree


def signing_key(secret, day, region):
    key = ("AWS4" + secret).encode()
    for part in (day, region, "s3", "aws4_request"):
        key = hmac.new(key, part.encode(), hashlib.sha256).digest()
    return key


class S3Client:
    def __init__(self, port, access_key, secret_key, region):
        self.port, self.access_key, self.secret_key, self.region = port, access_key, secret_key, region

    def ask(self, method, path, query=(), body=b""):
        now = datetime.datetime.now(datetime.timezone.utc).strftime("%Y%m%dT%H%M%SZ")
        host, sum_ = f"127.0.0.1:{self.port}", hashlib.sha256(body).hexdigest()
        path = urllib.parse.quote(path)
        asked = "&".join(f"{key}={urllib.parse.quote(value, safe='')}" for key, value in sorted(query))
        signed = "host;x-amz-content-sha256;x-amz-date"
        canonical = f"{method}\n{path}\n{asked}\nhost:{host}\nx-amz-content-sha256:{sum_}\nx-amz-date:{now}\n\n{signed}\n{sum_}"
        scope = f"{now[:8]}/{self.region}/s3/aws4_request"
        text = f"AWS4-HMAC-SHA256\n{now}\n{scope}\n{hashlib.sha256(canonical.encode()).hexdigest()}"
        signature = hmac.new(signing_key(self.secret_key, now[:8], self.region), text.encode(), hashlib.sha256).hexdigest()
        headers = {
            "Host": host, "x-amz-date": now, "x-amz-content-sha256": sum_,
            "Authorization": f"AWS4-HMAC-SHA256 Credential={self.access_key}/{scope}, SignedHeaders={signed}, Signature={signature}",
        }
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=30)
        try:
            connection.request(method, path + ("?" + asked if asked else ""), body, headers)
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def demand(self, *asked, **more):
        status, body = self.ask(*asked, **more)
        if status not in (200, 201, 204):
            raise RuntimeError(f"{asked[:2]}: {status} {body[:500]!r}")
        return body

    def make_bucket(self, bucket):
        self.demand("PUT", "/" + bucket)

    def put(self, bucket, key, body):
        self.demand("PUT", f"/{bucket}/{key}", body=body)

    def get(self, bucket, key):
        return self.demand("GET", f"/{bucket}/{key}")

    def delete(self, bucket, key):
        self.demand("DELETE", f"/{bucket}/{key}")

    def keys(self, bucket, prefix=""):
        body = self.demand("GET", "/" + bucket, query=[("list-type", "2"), ("prefix", prefix)])
        return sorted(element.text for element in xml.etree.ElementTree.fromstring(body).iter() if element.tag.split("}")[-1] == "Key")
