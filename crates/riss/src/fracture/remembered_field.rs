//! Gradients that are computed once where several integrals ask for the same points.

use super::interaction_integral::GradientField;
use crate::error::Result;
use crate::math::{Matrix2, Vector2};
use rustc_hash::FxHashMap;
use std::sync::{Mutex, PoisonError};

/// A field that remembers its gradients: J, the factors and the configurational force at a tip take the same domains.
///
/// Points that are asked for together are remembered together, so that what is found again has the bits of the first time.
#[derive(Debug)]
pub struct RememberedField<'a, F> {
    field: &'a F,
    known: Mutex<FxHashMap<Key, Matrix2>>,
}

/// Bits of the place and of where it sees from.
type Key = [u64; 4];

fn key([at, sight]: &[Vector2; 2]) -> Key {
    [at.x, at.y, sight.x, sight.y].map(f64::to_bits)
}

impl<'a, F: GradientField> RememberedField<'a, F> {
    /// The field, with nothing known of it.
    pub fn new(field: &'a F) -> Self {
        Self { field, known: Mutex::default() }
    }

    fn with<R>(&self, act: impl FnOnce(&mut FxHashMap<Key, Matrix2>) -> R) -> R {
        act(&mut self.known.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

impl<F: GradientField> GradientField for RememberedField<'_, F> {
    type Buffer = F::Buffer;

    fn gradient(&self, at: Vector2, sight: Vector2, buffer: &mut Self::Buffer) -> Result<Matrix2> {
        let mut found = vec![];
        self.gradients(&[[at, sight]], buffer, &mut found)?;
        Ok(found[0])
    }

    fn gradients(&self, views: &[[Vector2; 2]], buffer: &mut Self::Buffer, gradients: &mut Vec<Matrix2>) -> Result<()> {
        gradients.clear();
        self.with(|known| gradients.extend(views.iter().map_while(|view| known.get(&key(view)))));
        if gradients.len() < views.len() {
            self.field.gradients(views, buffer, gradients)?;
            self.with(|known| known.extend(views.iter().map(key).zip(gradients.iter().copied())));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicUsize, Ordering};

    /// Counts how often it is asked.
    #[derive(Default)]
    struct Counted(AtomicUsize);

    impl GradientField for Counted {
        type Buffer = ();
        fn gradient(&self, at: Vector2, sight: Vector2, _: &mut ()) -> Result<Matrix2> {
            self.0.fetch_add(1, Ordering::Relaxed);
            Ok(Matrix2::new(at.x, at.y, sight.x, sight.y))
        }
    }

    #[test]
    fn each_point_is_asked_for_once() {
        let counted = Counted::default();
        let field = RememberedField::new(&counted);
        let view = |x: f64, side: f64| [Vector2::new(x, 0.0), Vector2::new(x, side)];
        let views = [view(1.0, 1.0), view(1.0, -1.0), view(2.0, 1.0)];
        let mut gradients = vec![];
        for _ in 0..3 {
            field.gradients(&views, &mut (), &mut gradients).unwrap();
            // The sides of a crack are two points.
            assert_eq!(gradients, views.map(|[at, sight]| Matrix2::new(at.x, at.y, sight.x, sight.y)));
        }
        assert_eq!(field.gradient(views[2][0], views[2][1], &mut ()).unwrap(), gradients[2]);
        assert_eq!((counted.0.load(Ordering::Relaxed), field.with(|known| known.len())), (3, 3));
    }
}
