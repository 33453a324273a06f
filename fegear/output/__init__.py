"""What a run writes: tables, summary, dataset, figures, report, exports. Nothing numerical imports this."""
