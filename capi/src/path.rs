//! What a controller flies: a path of the parameters, or a route in lent memory.

#[cfg(feature = "curves")]
pub use every::{FlownPath, of};
#[cfg(not(feature = "curves"))]
pub use lean::{FlownPath, of};

/// Any of the parameters' paths.
#[cfg(feature = "curves")]
mod every {
    use crate::route::LentTable;
    use controller::OutOfRange;
    use rig::{AnyPath, HARMONICS, NoFormula, Parameters};

    pub type FlownPath = AnyPath<f32, NoFormula, NoFormula, HARMONICS, LentTable>;

    pub fn of(parameters: &Parameters<f32>) -> Result<FlownPath, OutOfRange<f32>> {
        rig::path(parameters)
    }
}

/// The circle alone of the parameters' paths.
#[cfg(not(feature = "curves"))]
mod lean {
    use crate::route::LentTable;
    use controller::{Circle, OutOfRange, Outputs, Path, PositionSeries, Profiled, Route, Vector3};
    use rig::{AnySpeed, AnyYaw, Parameters, parameter};

    #[derive(Clone, Debug)]
    pub enum FlownPath {
        Circle(Profiled<Circle<f32>, AnySpeed<f32>, AnyYaw<f32>>),
        Route(Route<f32, LentTable>),
    }

    pub fn of(parameters: &Parameters<f32>) -> Result<FlownPath, OutOfRange<f32>> {
        OutOfRange::check("PATH_KIND", parameters.get(parameter!("PATH_KIND")), 0.0, 0.0)?;
        let [radius, p3] = [parameter!("PATH_RADIUS"), parameter!("PATH_P3")].map(|number| parameters.get(number));
        let (speed, yaw) = (AnySpeed::new(parameters)?, AnyYaw::new(parameters)?);
        Ok(FlownPath::Circle(Profiled { curve: Circle::new(radius, p3)?, speed, yaw }))
    }

    macro_rules! either {
        ($self:expr, $path:ident => $value:expr) => {
            match $self {
                FlownPath::Circle($path) => $value,
                FlownPath::Route($path) => $value,
            }
        };
    }

    impl Path<f32> for FlownPath {
        fn evaluate(&mut self, position: &PositionSeries<f32>, outputs: &mut Outputs<f32>) {
            either!(self, path => path.evaluate(position, outputs));
        }

        fn search(&mut self, position: &Vector3<f32>) -> bool {
            either!(self, path => path.search(position))
        }

        fn dwell(&self) -> Option<f32> {
            either!(self, path => path.dwell())
        }

        fn go_on(&mut self) -> bool {
            either!(self, path => path.go_on())
        }

        fn set_backward(&mut self, is_backward: bool) -> bool {
            either!(self, path => path.set_backward(is_backward))
        }
    }
}
