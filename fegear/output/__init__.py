"""What a run writes: tables, summary, dataset, pictures, report, exports. Nothing numerical imports this."""
