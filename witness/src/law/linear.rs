//! The 4×4 solve of (3.10).

/// Solves `matrix` · u = `rhs` by Gaussian elimination with partial pivoting; `None` without a
/// finite, non-zero pivot.
pub fn solve<const N: usize>(mut matrix: [[f64; N]; N], mut rhs: [f64; N]) -> Option<[f64; N]> {
    for column in 0..N {
        let pivot = (column..N).max_by(|&i, &j| {
            let (left, right) = (matrix[i][column].abs(), matrix[j][column].abs());
            left.total_cmp(&right)
        })?;
        let largest = matrix[pivot][column];
        if largest == 0.0 || !largest.is_finite() {
            return None;
        }
        matrix.swap(column, pivot);
        rhs.swap(column, pivot);
        let pivot_row = matrix[column];
        for row in column + 1..N {
            let factor = matrix[row][column] / largest;
            for (entry, above) in matrix[row].iter_mut().zip(pivot_row) {
                *entry -= factor * above;
            }
            rhs[row] -= factor * rhs[column];
        }
    }
    let mut solution = [0.0; N];
    for row in (0..N).rev() {
        let known: f64 = (row + 1..N).map(|k| matrix[row][k] * solution[k]).sum();
        solution[row] = (rhs[row] - known) / matrix[row][row];
    }
    Some(solution)
}

#[cfg(test)]
mod tests {
    use super::solve;

    /// Numbers whose elimination is exact in binary.
    #[test]
    fn solves_with_a_zero_on_the_diagonal_and_refuses_a_singular_matrix() {
        let solution = solve([[0.0, 2.0, 1.0], [1.0, 1.0, 0.0], [4.0, 0.0, -1.0]], [7.0, 3.0, 1.0]);
        assert_eq!(solution, Some([1.0, 2.0, 3.0]));
        assert_eq!(solve([[1.0, 2.0], [2.0, 4.0]], [1.0, 1.0]), None);
        assert_eq!(solve([[f64::NAN]], [1.0]), None);
    }
}
