//! Where the boxes of small drives stand.

use super::{Diagram, DiagramPart};

fn part(name: &str, class: &str) -> DiagramPart {
    DiagramPart {
        name: name.to_owned(),
        class: class.to_owned(),
    }
}

/// An input, a controller, a motor that is read back, and three bodies at one joint.
fn drive() -> Diagram {
    Diagram {
        parts: vec![
            part("r", ""),
            part("control", "Controller"),
            part("motor", "Motor"),
            part("brake", "Brake"),
            part("screw", "Screw"),
            part("table", "Mass"),
        ],
        joints: vec![vec![2, 3, 4], vec![4, 5]],
        signals: vec![(0, 1), (1, 2), (2, 1)],
    }
}

#[test]
fn what_drives_stands_left_of_what_it_drives() {
    let layers = super::layers(&drive());
    // The joint of motor, brake and screw is the last node.
    assert_eq!(layers.columns, [0, 2, 4, 6, 6, 8, 5]);
    // The screw leads further than the brake.
    assert_eq!(layers.rows, [0, 0, 0, 1, 0, 0, 0]);
}

#[test]
fn no_box_stands_on_another_and_all_is_on_the_picture() {
    let diagram = drive();
    let font = crate::draw::Font::new();
    let places = diagram.places(&super::layers(&diagram), &font);
    let drawing = diagram.drawing();
    let boxes = &places[..diagram.parts.len()];
    for (number, area) in boxes.iter().enumerate() {
        assert!(area.right < drawing.width && area.bottom < drawing.height);
        assert!(
            boxes[number + 1..]
                .iter()
                .all(|other| !area.overlaps(other))
        );
    }
}

#[test]
fn a_ring_and_a_part_alone_have_places_too() {
    let ring = Diagram {
        parts: vec![
            part("a", "A"),
            part("b", "B"),
            part("c", "C"),
            part("d", "D"),
        ],
        joints: vec![vec![0, 1], vec![1, 2], vec![2, 0]],
        signals: Vec::new(),
    };
    let layers = super::layers(&ring);
    assert_eq!(layers.columns, [0, 2, 4, 0]);
    assert!(ring.to_svg().0.contains(">d</text>"));
}

#[test]
fn bars_of_joints_that_reach_as_far_stand_side_by_side() {
    // A belt and a screw, each at one joint with two bodies of the next column.
    let diagram = Diagram {
        parts: ["belt", "screw", "motor", "brake", "table", "guide"]
            .map(|name| part(name, "Part"))
            .to_vec(),
        joints: vec![vec![0, 1], vec![0, 2, 3], vec![1, 4, 5]],
        signals: vec![(0, 2), (1, 3)],
    };
    let layers = super::layers(&diagram);
    let font = crate::draw::Font::new();
    let places = diagram.places(&layers, &font);
    let joints: Vec<usize> = layers.joints.iter().flatten().copied().collect();
    let [first, second] = joints[..] else {
        panic!("{joints:?}")
    };
    let apart = layers.columns[first] != layers.columns[second];
    assert!(apart || (places[first].left - places[second].left).abs() > 5.0);
    let diagram = drive();
    assert_eq!(super::layers(&diagram).bars, [0; 7]);
}
