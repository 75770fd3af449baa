//! The page's costs are those of the compiler, and the whole mix holds its parts.

use mixer_compiler::Compiled;
use mixer_compiler::cost::Cost;
use roxmltree::Node;

use super::named;

/// Reads the section on the target's cost.
pub(crate) fn assert_cost(page: Node<'_, '_>, compiled: &Compiled) {
    let name = &compiled.airframe.name;
    let section = named(page, "section")
        .find(|node| node.attribute("id") == Some("cost"))
        .unwrap();
    let text: String = section.descendants().filter_map(|node| node.text()).collect();
    assert!(text.contains("Cortex-M4F, counted in QEMU"), "{name}: {text}");
    let cells = |row: Node<'_, '_>| -> Vec<String> {
        let cells = row.children().filter(Node::is_element);
        cells
            .map(|cell| cell.text().unwrap_or_default().to_owned())
            .collect()
    };
    let rows: Vec<Vec<String>> = named(section, "tr").map(cells).collect();

    let cost = Cost::new(compiled);
    if let Some(bound) = cost.bound_instructions {
        assert!(
            text.contains(&format!("at most {bound} instructions")),
            "{name}: no {bound}"
        );
        assert!(cost.attainable_instructions < Some(bound), "{name}: {cost:?}");
        let with_rotors_out = cost.bound_with_rotors_out_instructions.unwrap();
        assert!(
            text.contains(&format!("at most {with_rotors_out} instructions")),
            "{name}: no {with_rotors_out}"
        );
    }
    assert_eq!(
        cost.delivered_error.map(|error| error > 0.0 && error < 0.2),
        cost.delivered_instructions.map(|_| true),
        "{name}: {cost:?}"
    );
    let chosen = rows
        .iter()
        .find(|row| row.first().is_some_and(|name| name.ends_with("(chosen)")));
    let Some(chosen) = chosen else {
        // A polynomial of another degree is not among those that the compiler chooses from.
        assert_eq!(compiled.evaluator.name(), "polynomial", "{name}: none is chosen");
        assert_eq!(cost.inverse_instructions, None, "{name}");
        assert!(text.contains("not counted"), "{name}");
        return;
    };
    let numbers: Vec<u32> = chosen[1..].iter().map(|cell| cell.parse().unwrap()).collect();
    let [one, cycles, mix, bytes] = numbers[..] else {
        panic!("{name}: {chosen:?}")
    };
    assert_eq!(Some(one), cost.inverse_instructions, "{name}");
    assert_eq!(Some(cycles), cost.inverse_cycles, "{name}");
    assert_eq!(Some(mix), cost.delivered_instructions, "{name}");
    assert_eq!(bytes as usize, cost.inverse_bytes, "{name}");
    assert!(one < cycles && one < mix, "{name}: {chosen:?}");
    assert!(cost.inverse_bytes < cost.table_bytes, "{name}");
}
