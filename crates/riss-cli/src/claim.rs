//! A folder of results is written by one run at a time.

use std::fs::{File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// Stands in the folder while a run writes there. The system frees its lock however the run ends.
const LOCK_FILE: &str = ".riss.lock";

/// A folder that no other run writes into as long as this lives.
pub struct Claim {
    path: PathBuf,
    // Holds the lock.
    file: File,
}

impl Claim {
    /// Makes the folder and claims it; that a file can be written there is tried on the way.
    ///
    /// # Errors
    /// What the system says, or that another run has the folder.
    pub fn of(dir: &Path) -> io::Result<Self> {
        std::fs::create_dir_all(dir)?;
        let path = dir.join(LOCK_FILE);
        let file = OpenOptions::new().create(true).write(true).truncate(false).open(&path)?;
        match file.try_lock() {
            Ok(()) => Ok(Self { path, file }),
            Err(TryLockError::WouldBlock) => {
                Err(io::Error::other("another run is writing there; give each its own --out"))
            }
            // A file system without locks cannot tell.
            Err(TryLockError::Error(e)) if e.kind() == io::ErrorKind::Unsupported => Ok(Self { path, file }),
            Err(TryLockError::Error(e)) => Err(e),
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // While it is locked, so that no other run has claimed what is removed.
        let _ = std::fs::remove_file(&self.path);
        let _ = self.file.unlock();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_belongs_to_one_at_a_time() {
        let dir = tempfile::tempdir().unwrap();
        let claim = Claim::of(dir.path()).unwrap();
        assert!(Claim::of(dir.path()).err().unwrap().to_string().contains("another run"));
        drop(claim);
        assert_eq!(std::fs::read_dir(dir.path()).unwrap().count(), 0);
        Claim::of(dir.path()).unwrap();
    }
}
