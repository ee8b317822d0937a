//! The stream around an archive's files: its header, its end, and no more of it than is wanted.

use std::io::{self, BufRead, Read};

use flate2::bufread::GzDecoder;

/// The unit of a tar file.
pub(super) const BLOCK: usize = 512;

/// Said of what is sound, perhaps, but cannot be told from what is not.
pub(super) const OTHERWISE: &str = "is not as `validate archive` writes it; what another program has packed can be checked unpacked: \
                         validate verify FOLDER";

/// The time in the header of a gzip stream (RFC 1952), of which nothing is taken. Nothing else may vary in it: no checksum would
/// tell of a change.
pub(super) fn gzip_time(stream: &mut impl BufRead) -> Result<u32, String> {
    let unreadable = |error| format!("damaged in the gzip header ({error})");
    match *stream.fill_buf().map_err(unreadable)? {
        [0x1f, 0x8b, 8, 0, a, b, c, d, 0, 255, ..] => Ok(u32::from_le_bytes([a, b, c, d])),
        [0x1f, 0x8b, 8, _, _, _, _, _, _, _, ..] => Err(format!("the gzip header {OTHERWISE}")),
        _ => Err("damaged or not a .tar.gz: no gzip header".into()),
    }
}

/// The end of a `.tar.gz`: one more block of zeros, the checksum and size of it all, nothing.
pub(super) fn end(mut stream: Capped<GzDecoder<impl BufRead>>) -> Result<(), String> {
    let damaged = |error| format!("damaged behind its last file, in the gzip trailer ({error})");
    let mut block = [0; BLOCK];
    stream.read_exact(&mut block).map_err(damaged)?;
    let more = stream.read(&mut [0]).map_err(damaged)?;
    if block != [0; BLOCK] || more > 0 {
        return Err("something follows the last file".into());
    }
    let mut rest = stream.inner.into_inner();
    if !rest.fill_buf().map_err(damaged)?.is_empty() {
        return Err("something follows the gzip trailer".into());
    }
    Ok(())
}

/// A reader that fails beyond a number of bytes: a small file may unpack to a huge one.
pub(super) struct Capped<R> {
    pub inner: R,
    pub left: u64,
}

impl<R: Read> Read for Capped<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let n = self.inner.read(buffer)?;
        self.left = self
            .left
            .checked_sub(n as u64)
            .ok_or_else(|| io::Error::other("it unpacks to more than is read of any archive"))?;
        Ok(n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_more_than_the_cap_is_unpacked() {
        let mut capped = Capped {
            inner: io::repeat(0),
            left: 1000,
        };
        let error = io::copy(&mut capped, &mut io::sink()).expect_err("an end");
        assert!(error.to_string().contains("unpacks to more"));
    }
}
