"""Contents of files: valid ones with edits, as people, programs and disks make them."""

from __future__ import annotations

from hypothesis import strategies as st

TOKENS = [
    b"", b",", b";", b"\t", b"\n", b"\r\n", b'"', b"'", b"#", b" ", b"\0", b"\xff", b"\xfe\xff", b"\xef\xbb\xbf",
    b"\xc2\xb0", b"nan", b"inf", b"-", b"-1", b"0", b"1e999", b"-1e-999", b"1e5", b"9" * 400, b"9" * 5000, b"1,5",
    b"1.5", b"1 000", b"0x10", b"\xd9\xa3", b"=1+1", b'=HYPERLINK("x")', b"@SUM(A1)", b"+cmd|' /C calc'!A0",
    b"{{ 7*7 }}", b"../../etc/passwd", b"/etc/passwd", b"!!python/object/apply:os.system [echo]", b"&a [*a, *a]", b"*a",
    b"<<: *a", b"? [1, 2]", b": ", b"- ", b"{", b"}", b"[", b"]", b"[" * 3000, b"null", b"true", b"E_MPa", b"E (GPa)",
    b"T (\xc2\xb0C)", b"specimen", b"record", b"\\", b"$(touch x)", b"`touch x`",
]  # fmt: skip
# Where (a share of the length), how much is taken away, and what is put there.
EDIT = st.tuples(
    st.floats(0.0, 1.0),
    st.sampled_from([0, 0, 1, 1, 2, 5, 20, 100_000]),
    st.one_of(
        st.sampled_from(TOKENS), st.binary(max_size=6), st.text(max_size=6).map(lambda text: text.encode())
    ),
)
FLIP = st.tuples(st.floats(0.0, 1.0), st.integers(0, 7))


def texts(begin: tuple[bytes, ...]) -> st.SearchStrategy[bytes]:
    """Mostly a valid file with some edits, at times bytes without any sense."""
    edited = st.builds(_edited, st.sampled_from(begin), st.lists(EDIT, max_size=4))
    return st.one_of(edited, edited, edited, st.binary(max_size=200))


def binaries(begin: tuple[bytes, ...]) -> st.SearchStrategy[bytes]:
    """Valid files with bits flipped, or cut."""
    flipped = st.builds(_flipped, st.sampled_from(begin), st.lists(FLIP, min_size=1, max_size=8))
    cut = st.builds(
        lambda data, part: data[: int(part * len(data))], st.sampled_from(begin), st.floats(0.0, 1.0)
    )
    return st.one_of(flipped, flipped, cut)


def _edited(data: bytes, edits: list[tuple[float, int, bytes]]) -> bytes:
    for share, away, put in edits:
        place = int(share * len(data))
        data = data[:place] + put + data[place + away :]
    return data


def _flipped(data: bytes, flips: list[tuple[float, int]]) -> bytes:
    changed = bytearray(data)
    for share, bit in flips:
        changed[min(int(share * len(data)), len(data) - 1)] ^= 1 << bit
    return bytes(changed)
