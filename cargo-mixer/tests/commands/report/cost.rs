//! The page's costs are those of the compiler, and the whole mix holds its parts.

use mixer_compiler::Compiled;
use mixer_facts::cost::Cost;
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
    let cost = Cost::new(compiled);
    if let Some(bound) = cost.bound_instructions {
        assert!(
            text.contains(&format!("{bound} instructions at most")),
            "{name}: no {bound}"
        );
        assert!(cost.attainable_instructions < Some(bound), "{name}: {cost:?}");
        let with_rotors_out = cost.bound_with_rotors_out_instructions.unwrap();
        assert!(
            text.contains(&format!("{with_rotors_out} instructions at most")),
            "{name}: no {with_rotors_out}"
        );
    }
    assert_eq!(
        cost.delivered_error.map(|error| error > 0.0 && error < 0.2),
        cost.delivered_instructions.map(|_| true),
        "{name}: {cost:?}"
    );
    match (
        cost.inverse_instructions,
        cost.inverse_cycles,
        cost.delivered_instructions,
    ) {
        (Some(one), Some(cycles), Some(mix)) => {
            assert!(one < cycles && one < mix, "{name}: {cost:?}");
            for number in [one, cycles, mix] {
                assert!(
                    text.contains(&number.to_string()),
                    "{name}: no {number} in {text}"
                );
            }
        }
        // A polynomial of another degree is not counted.
        _ => assert!(text.contains("not counted"), "{name}: {text}"),
    }
    assert!(
        text.contains(&format!("{} bytes", cost.inverse_bytes)),
        "{name}: {text}"
    );
    assert!(cost.inverse_bytes < cost.table_bytes, "{name}");
}
