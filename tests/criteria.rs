//! One table, the registry, and everything that shows or tries the criteria.

use crate::registry::{criteria, tapes};
use crate::support::{fem, root, strip};
use fem::Registry;
use fem::core::failure::check_material;
use fem::core::plugin::Kind;
use fem::core::testkit::check_criterion;

#[test]
fn every_criterion_is_listed_described_offered_and_tried() {
    let listed = fem(&root(), &["list", "criteria"]).good().stdout;
    let book = std::fs::read_to_string(root().join("docs/book/src/criteria-table.md")).unwrap();
    let costs = std::fs::read_to_string(root().join("docs/book/src/criteria-costs.md")).unwrap();
    let refused = strip().scene("\"hashin-report\"", "\"no-such-criterion\"").fem("run", &[]);
    assert_eq!(refused.status, 1);
    let refused = refused.stderr.replace("│", "").split_whitespace().collect::<String>();
    let (_, offered) = refused.split_once("(known:").unwrap();
    let offered: Vec<_> = offered.split(')').next().unwrap().split(',').collect();
    let all = criteria();
    assert_eq!(offered, all.iter().map(|(info, _)| info.name).collect::<Vec<_>>());
    assert_eq!(all.len(), Registry::standard().list(Kind::Criterion).count());

    for (info, criterion) in &all {
        let name = info.name;
        assert!(listed.lines().any(|line| line.starts_with(&format!("{name} "))), "{name} is not listed");
        assert!(book.lines().any(|line| line == format!("## {name}")), "{name} is not in the book");
        assert!(costs.lines().any(|line| line.starts_with(&format!("| `{name}` |"))), "{name} has no cost in the book");
        let suitable: Vec<_> = tapes().into_iter().filter(|m| check_material(&**criterion, name, m).is_ok()).collect();
        assert!(suitable.len() >= 4, "{name} suits {} materials", suitable.len());
        for m in suitable {
            check_criterion(&**criterion, &m).unwrap_or_else(|why| panic!("{name} on {}: {why}", m.name));
        }
    }
}
