//! Compiled models, shared by the instances of a process: compiling is what an instance costs.

use hyde_fmi::{Kept, Model, RESOURCE};
use hyde_study::world::{Disk, World as _};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};

static MODELS: Mutex<BTreeMap<String, Weak<Model>>> = Mutex::new(BTreeMap::new());

/// The model of a folder of resources, which the description with this token describes.
pub(crate) fn model(resources: &Path, token: &str) -> Result<Arc<Model>, String> {
    let bytes = Disk.read(&resources.join(RESOURCE))?;
    let own = Kept::token(&bytes);
    if own != token {
        return Err(format!(
            "the token of the description is `{token}`, that of the resources `{own}`: they are not of one FMU"
        ));
    }
    let mut models = MODELS.lock().unwrap_or_else(PoisonError::into_inner);
    models.retain(|_, model| model.strong_count() > 0);
    if let Some(model) = models.get(&own).and_then(Weak::upgrade) {
        return Ok(model);
    }
    let model = Arc::new(Model::of(&Kept::from_bytes(&bytes)?)?);
    models.insert(own, Arc::downgrade(&model));
    Ok(model)
}

/// The folder that a `file:` URI names, as FMI 2 hands it over; a plain path is taken as it is.
pub(crate) fn folder_of(uri: &str) -> PathBuf {
    let Some(rest) = uri.strip_prefix("file:") else {
        return PathBuf::from(uri);
    };
    let path = match rest.strip_prefix("//") {
        // Behind the name of the machine, which is empty or this one.
        Some(rest) => rest.find('/').map_or(rest, |at| &rest[at..]),
        None => rest,
    };
    let mut bytes = Vec::new();
    let mut left = path.as_bytes().iter();
    while let Some(&byte) = left.next() {
        let digits = left.as_slice().get(..2).filter(|_| byte == b'%');
        let digits = digits.and_then(|two| std::str::from_utf8(two).ok());
        match digits.and_then(|two| u8::from_str_radix(two, 16).ok()) {
            Some(escaped) => {
                bytes.push(escaped);
                left.nth(1);
            }
            None => bytes.push(byte),
        }
    }
    PathBuf::from(String::from_utf8_lossy(&bytes).into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_uri_is_read_with_its_escapes() {
        for (uri, path) in [
            ("file:///tmp/a%20b/resources", "/tmp/a b/resources"),
            ("file://localhost/tmp/x", "/tmp/x"),
            ("file:/tmp/x", "/tmp/x"),
            ("/tmp/100%", "/tmp/100%"),
            ("file:///tmp/100%", "/tmp/100%"),
        ] {
            assert_eq!(folder_of(uri), Path::new(path), "{uri}");
        }
    }
}
