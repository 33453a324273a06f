"""3D gears: influence functions of the whole solid gear, spur and helical, at the cost of one tooth.

    from fegear.fem.solid import bands, hats, solid_influence

    known = solid_influence(section, tau, width, poisson_ratio, bore_radius)   # lengths in modules of the section
    contact = hats(radius, stations, known.band_half_width(radius), slope=slope)
    known.deflection(k, contact, contact)               # (P, P), 1 / (E module) per unit force
    known.contact_compliance(radius, stations, b)       # c_0 of contacts of Hertzian half-width b along a contact line
    known.fillet_stress(k, "tension", contact, zeta)    # (3, points, Z, P), 1 / module^2 per unit force
    known.error, known.contact_error(radius, stations, b), known.seconds, known.settings

    solid_influence(..., settings=solid_settings(3e-3), held=(-1.0, 2.0), cache=SolutionCache(...))

- `section` is the transverse section (`geometry.external_tooth.Tooth`), lengths in its modules, tooth 0 on the y
  axis, loaded flank at x > 0, tooth k = +1 clockwise. z runs along the axis out of that drawing, 0 in the middle of the
  face; `tau` = tan(beta) / r is the twist per module, positive for a right hand: the section at z is turned
  counterclockwise by tau z.
- A band (`Bands`) is a semi-elliptic pressure up the flank times a profile along the face, and carries a unit of
  transverse force. `hats` puts them on the stations of a contact line; `slope` is d(arc up the flank)/dz of that line.
  Deflections are -N . u with N = (n, tau t . x), the approach along the transverse line of action, weighted with the
  watched band's own pressure: c_k(p, q) = c_-k(q, p).
- `deflection` is that of the pressed bands as wide as they are given (`band_half_width` is what the section resolves)
  and as polynomials along the face see them: right for other teeth and other places. For a contact line's own
  compliance take `contact_compliance`: Hertz's width, what the polynomials leave out, free end faces. On one line of
  contact a width b enters as -(1 - nu^2) / (pi E cos(beta_b)) * overlap * (ln b_i + ln b_j), so that a load-dependent
  width needs no second call (`contact.line_compliance`, `bands.overlap`).
- Contact lines on the flank: `line_slope(radius)` is d(arc)/dz, and on the base tangent their length from the base
  circle is sqrt(r^2 - r_b^2) = rho_0 - tau r_b z.
- Fillet stresses are of the free surface: up the fillet in the transverse section, across it, shear between both;
  `known.fine.fillets[side]` says where the points lie (`place` in the section at z = 0, `arc`, `tangent_angle`).
- `solve_solid`, `solve_slices` (coupled along the face by laws) and `solve_thin_slices` (not coupled at all, to compare
  with) take the same arguments; what each returns is a `flank_body.FlankBody`, ready for `fegear.contact.wide`.
"""
