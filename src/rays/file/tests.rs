use super::*;

const HEAD: &str = "ox,oy,oz,dx,dy,dz,tmax\n";

fn csv(text: &str) -> Result<Vec<Cast>, String> {
    csv::parse("r.csv", &mut text.as_bytes()).map_err(|error| error.to_string())
}

fn npy(bytes: &[u8]) -> Result<Vec<Cast>, String> {
    npy::parse("r.npy", bytes).map_err(|error| error.to_string())
}

/// A file as NumPy writes it.
fn file(version: u8, header: &str, rows: &[f64]) -> Vec<u8> {
    let mut bytes = b"\x93NUMPY".to_vec();
    bytes.extend([version, 0]);
    match version {
        1 => bytes.extend((header.len() as u16).to_le_bytes()),
        _ => bytes.extend((header.len() as u32).to_le_bytes()),
    }
    bytes.extend(header.bytes());
    bytes.extend(rows.iter().flat_map(|x| x.to_le_bytes()));
    bytes
}

fn header(shape: &str) -> String {
    format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}   \n")
}

const ROWS: [f64; 14] = [
    0.1,
    0.2,
    0.3,
    0.0,
    -0.0,
    2.0,
    5.0, // one row
    1.0,
    2.0,
    3.0,
    1e-320,
    1e50,
    1.0,
    f64::INFINITY,
];

#[test]
fn both_forms_give_the_same_rays() {
    let text = "0.1,0.2,0.3,0,-0.0,2,5\n 1 ,2,3,1e-320,1e50,1.0,\n";
    let rays = csv(&(HEAD.to_owned() + text)).expect("rays");
    for version in [1, 2, 3] {
        let bytes = file(version, &header("(2, 7)"), &ROWS);
        assert_eq!(npy(&bytes).expect("rays"), rays);
    }
    // The keys may come in any order, and in either quotes.
    let header = "{\"shape\":(2,7),\"fortran_order\":False,\"descr\":\"<f8\"}";
    assert_eq!(npy(&file(1, header, &ROWS)).expect("rays"), rays);
    assert_eq!(rays[0].span, Span { t0: 0.0, t1: 5.0 });
    assert_eq!(rays[1].span, Span::from(0.0));
    assert_eq!(rays[1].direction, DVec3::new(1e-320, 1e50, 1.0));

    // Without an end; a byte order mark and carriage returns.
    let short = csv("\u{feff}ox,oy,oz,dx,dy,dz\r\n1,2,3,4,5,6\r\n").expect("rays");
    let row = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
    assert_eq!(npy(&file(1, &self::header("(1, 6)"), &row)), Ok(short));
}

#[test]
fn wrong_text_is_told_with_its_line() {
    for (text, told) in [
        (
            "",
            "r.csv: the file is empty; expected 'ox,oy,oz,dx,dy,dz' or 'ox,",
        ),
        (
            "ox,oy\n1,2\n",
            "r.csv:1: the header is 'ox,oy'; expected 'ox,",
        ),
        (
            "1,2,3,4,5,6\n",
            "r.csv:1: the header is '1,2,3,4,5,6'; expected",
        ),
        (
            HEAD,
            "r.csv: there are no rays in it; expected at least one",
        ),
    ] {
        let error = csv(text).expect_err(text);
        assert!(error.starts_with(told), "{error}");
    }
    for (row, told) in [
        ("1,2,3,4,5", "5 fields; expected 7, as in the header"),
        ("1,2,3,4,5,6,7,8", "8 fields; expected 7"),
        ("1,2,x,4,5,6,", "oz is 'x'; expected a number"),
        ("1,,3,4,5,6,", "oy is ''; expected a number"),
        ("1,2,3,4,NaN,6,", "dy is NaN; it must be a finite number"),
        ("1e999,2,3,4,5,6,", "ox is inf; it must be a finite number"),
        ("1,2,3,0,-0.0,0,", "the direction is zero; at least one of"),
        (
            "1,2,3,0,1e-51,0,",
            "the largest part of the direction is 1e-51; it must lie within 1e-50 to 1e50",
        ),
        (
            "1,2,3,1,-1e51,0,",
            "the largest part of the direction is 1e51; it must",
        ),
        (
            "1,2,3,4,5,6,-1e-9",
            "tmax is -0.000000001; it must be 0 or more",
        ),
        ("1,2,3,4,5,6,nan", "tmax is NaN; it must"),
        ("1,2,3,4,5,6,-inf", "tmax is -inf; it must"),
    ] {
        let error = csv(&format!("{HEAD}1,2,3,4,5,6,0\n\n{row}\n")).expect_err(row);
        assert!(error.starts_with(&format!("r.csv:4: {told}")), "{error}");
        assert!(!error.contains('\n'));
    }
    let bytes = [HEAD.as_bytes(), b"1,2,3,4,5,6,\n1,2,3,\xff,5,6,\n"].concat();
    let error = csv::parse("r.csv", &mut &bytes[..]).expect_err("not text");
    assert!(
        error.to_string().starts_with("r.csv:3: not UTF-8"),
        "{error}"
    );
}

#[test]
fn wrong_arrays_are_told_with_their_row() {
    let good = header("(2, 7)");
    for (old, new, told) in [
        (
            "<f8",
            "<f4",
            "r.npy: its type is '<f4'; expected an array of type '<f8'",
        ),
        ("<f8", ">f8", "r.npy: its type is '>f8'"),
        ("'<f8'", "[('x', '<f8')]", "r.npy: its type has fields"),
        ("False", "True", "r.npy: it is in Fortran order"),
        ("(2, 7)", "(7, 2)", "r.npy: its shape is (7, 2)"),
        ("(2, 7)", "(14,)", "r.npy: its shape is (14,)"),
        ("(2, 7)", "(1, 2, 7)", "r.npy: its shape is (1, 2, 7)"),
        ("(2, 7)", "(0, 7)", "r.npy: there are no rays in it"),
        (
            "(2, 7)",
            "(3, 7)",
            "r.npy: row 2: the file ends before its end; its header says 3 rows of 7",
        ),
        (
            "(2, 7)",
            "(18446744073709551615, 7)",
            "r.npy: row 2: the file ends",
        ),
        ("(2, 7)", "(1, 7)", "r.npy: something follows the last row"),
        ("(2, 7)", "(2, -7)", "r.npy: its shape is (2, -7)"),
        ("'shape'", "'form'", "r.npy: its header has no 'shape'"),
    ] {
        assert!(good.contains(old), "{old}");
        let error = npy(&file(1, &good.replace(old, new), &ROWS)).expect_err(new);
        assert!(error.starts_with(told), "{error}");
        assert!(!error.contains('\n'));
    }
    let whole = file(1, &good, &ROWS);
    for (length, told) in [
        (0, "r.npy: does not begin as a .npy file does"),
        (7, "r.npy: the file ends within its header"),
        (40, "r.npy: the file ends within its header"),
        (
            whole.len() - 1,
            "r.npy: row 1: the file ends before its end",
        ),
    ] {
        let error = npy(&whole[..length]).expect_err(told);
        assert!(error.starts_with(told), "{error}");
    }
    assert!(
        npy(&file(9, &good, &ROWS))
            .expect_err("version")
            .starts_with("r.npy: of version 9")
    );
    let mut rows = ROWS;
    rows[9] = f64::NAN;
    let error = npy(&file(1, &good, &rows)).expect_err("not finite");
    assert!(error.starts_with("r.npy: row 1: oz is NaN"), "{error}");
}

#[test]
fn files_are_known_by_their_ending() {
    let error = read(Path::new("rays.txt")).expect_err("another kind");
    assert_eq!(
        error.to_string(),
        "rays.txt: is no file of rays; expected a file ending in .csv or .npy"
    );
    let error = read(Path::new("no/such/rays.npy")).expect_err("no file");
    assert_eq!(error.to_string(), "no/such/rays.npy: cannot read the file");
}
